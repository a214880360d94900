#!/usr/bin/perl
# Writes what to train under as a latitude-longitude Radiance image of 256 x 128 pixels, another one for each seed.
# Usage: make_sky.pl SEED [sky|key] > SKY.hdr
#   sky   haze over ground, a small sun and softer lamps
#   key   one light as large as clvr's key light, which stays where it is in the world, in dim light from everywhere
use strict;
use warnings;

my $state = (shift // die "usage: make_sky.pl SEED [sky|key] > SKY.hdr\n") * 7919 + 12345;
my $key = (shift // 'sky') eq 'key';
sub uniform { # between two numbers (Lehmer's generator, the same on every machine)
    my ($low, $high) = @_;
    $state = $state * 16807 % 2147483647;
    return $low + ($high - $low) * $state / 2147483647;
}
uniform(0, 1) for 1 .. 8;
my $pi = 4 * atan2(1, 1);
my ($width, $height) = (256, 128);
my @zenith = (uniform(0.05, 0.4), uniform(0.1, 0.5), uniform(0.2, 0.9));
my @horizon = (uniform(0.3, 1.2), uniform(0.3, 1.1), uniform(0.3, 1));
my @ground = (uniform(0.02, 0.3), uniform(0.02, 0.25), uniform(0.02, 0.2));
my @lamps = map { # direction, cosine of its radius, radiance: an irradiance of 0.3 to 3
    my ($azimuth, $up) = (uniform(0, 2 * $pi), uniform($_ ? -0.2 : 0.1, 0.95));
    my $radius = ($_ ? uniform(4, 15) : uniform(1.5, 4)) * $pi / 180;
    my $strength = ($_ ? uniform(0.3, 1) : uniform(0.8, 3)) / ($pi * $radius**2);
    my ($warm, $across) = (uniform(0.6, 1), sqrt(1 - $up**2));
    { at => [$across * cos $azimuth, $across * sin $azimuth, $up], cosine => cos $radius, colour => [$strength, $strength * (1 + $warm) / 2, $strength * $warm] };
} 0 .. int uniform(1, 3.99);
if ($key) {
    my ($azimuth, $up, $radius, $dim) = (uniform(0, 2 * $pi), uniform(0.2, 0.9), 5 * $pi / 180, uniform(0.02, 0.3));
    my ($across, $strength) = (sqrt(1 - $up**2), uniform(1, 3) / ($pi * $radius**2));
    @lamps = ({ at => [$across * cos $azimuth, $across * sin $azimuth, $up], cosine => cos $radius, colour => [($strength) x 3] });
    $_ = $dim for @zenith, @horizon, @ground;
}

sub radiance {
    my ($azimuth, $elevation) = @_;
    my @d = (cos($elevation) * cos($azimuth), cos($elevation) * sin($azimuth), sin $elevation);
    my $share = $d[2] > 0 ? exp(-3 * $d[2]) : 1;
    my @c = map { $d[2] > 0 ? $zenith[$_] + ($horizon[$_] - $zenith[$_]) * $share : $ground[$_] } 0 .. 2;
    for my $lamp (@lamps) {
        my $cosine = $d[0] * $lamp->{at}[0] + $d[1] * $lamp->{at}[1] + $d[2] * $lamp->{at}[2];
        if ($cosine > $lamp->{cosine}) { $c[$_] += $lamp->{colour}[$_] for 0 .. 2 }
    }
    return @c;
}

binmode STDOUT;
print "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y $height +X $width\n";
for my $row (0 .. $height - 1) {
    for my $column (0 .. $width - 1) {
        my @c = radiance(2 * $pi * ($column + 0.5) / $width, $pi * (0.5 - ($row + 0.5) / $height));
        my ($most) = sort { $b <=> $a } @c;
        my $exponent = 1 + int(log($most) / log(2) + 128) - 128; # 2^exponent is above all three
        print pack 'C4', (map { int($_ * 256 / 2**$exponent) } @c), $exponent + 128;
    }
}
