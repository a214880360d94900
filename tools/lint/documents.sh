#!/bin/bash
# Refuses citations of what the project does not have: documents and sections (path/README.md, "Section"), files that a README or a comment names, and the documents that clvr was
# once designed by. Usage: documents.sh ROOT
set -euo pipefail
cd "$1"
find . \( -name .git -o -name build -o -path ./tools/lint \) -prune -o -type f \
    \( -name '*.[ch]pp' -o -name '*.h' -o -name '*.cl' -o -name '*.clh' -o -name '*.sh' -o -name '*.pl' -o -name '*.cmake' -o -name '*.txt' -o -name '*.md' -o -name '*.json' \) -print0 |
    LC_ALL=C sort -z | xargs -0 perl -e '
use strict;
my ($wrong, %sections) = (0);
my $folder = qr{(?:host|kernels|runtime|tests|tools|datasets)};

sub complain { print "$_[0]\n"; $wrong = 1 }
sub text_of { local $/; open(my $in, "<", $_[0]) or die "$_[0]: $!\n"; return scalar <$in> }
sub has_section {
    my ($document, $section) = @_;
    $sections{$document} //= { map { $_ => 1 } text_of($document) =~ /^#+ +(.*?) *$/mg };
    return $sections{$document}{$section};
}

for my $file (@ARGV) {
    my $text = text_of($file);
    (my $name = $file) =~ s{^\./}{};
    complain("$name: cites $1, which no clone has") if $text =~ /\b(DESIGN|SPEC|FACTS)\b(?=\.md|\W)/ || $text =~ /\b(kernel_study)\b/;
    $text =~ s{\n[ \t]*(?://[/!]?<?|\#|\*)?[ \t]*}{ }g if $name !~ /\.md$/; # a comment goes on in the next line
    while ($text =~ m{($folder/[\w./-]*\.md)`?((?:,?\s+(?:and\s+)?"[^"]+")*)}g) {
        my ($document, $list) = ($1, $2);
        if (!-f $document) { complain("$name: there is no $document"); next }
        while ($list =~ /"([^"]+)"/g) {
            (my $section = $1) =~ s/\s+/ /g;
            complain("$name: $document has no section \"$section\"") unless has_section($document, $section);
        }
    }
    if ($name =~ /\.(?:[ch]pp|clh?|h)$/ && $name !~ m{^tests/}) {
        while ($text =~ m{(?<![\w/.])((?:host|kernels|runtime|tests|tools)/[a-z0-9_./-]+\.(?:[ch]pp|clh?|h))\b}g) {
            complain("$name: there is no $1") unless -f $1;
        }
    }
    next if $name !~ m{(?:^|/)README\.md$};
    while ($text =~ m{`($folder/[\w./*-]+?\.(?:[ch]pp|clh?|h|sh|json|html|cmake|safetensors|jpg|png))`}g) {
        my ($path, @there) = ($1, glob($1));
        complain("$name: there is no $path") unless grep { -e } @there;
    }
}
exit $wrong;
'
