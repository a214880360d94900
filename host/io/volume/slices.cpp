#include "host/io/volume/slices.hpp"
#include "host/io/volume/numbered_name.hpp"
#include "host/io/volume/samples.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

namespace clvr {

namespace {

/// The names cut so that they have one pattern. Throws Error{input} where they have several: no file is left out in silence.
std::vector<NumberedName> names_of_one_stack(const std::string& folder, const std::vector<std::string>& files) {
    const auto relative = [&](const std::string& file) { return std::filesystem::path(file).lexically_relative(folder).string(); };
    std::map<std::string, std::vector<NumberedName>> first_try;
    for (const bool signs_after_letters : {false, true}) { // z-1, z0, z1: where only some have a minus, it is a sign
        std::map<std::string, std::vector<NumberedName>> stacks;
        for (const std::string& f : files) {
            NumberedName n = numbered_name(relative(f), signs_after_letters);
            stacks[n.pattern()].push_back(std::move(n));
        }
        if (stacks.size() == 1) return std::move(stacks.begin()->second);
        if (!signs_after_letters) first_try = std::move(stacks);
    }
    std::vector<const std::vector<NumberedName>*> stacks;
    for (const auto& s : first_try) stacks.push_back(&s.second);
    std::stable_sort(stacks.begin(), stacks.end(), [](auto* a, auto* b) { return a->size() > b->size(); });
    const auto &most = *stacks[0], &other = *stacks[1];
    const std::string more = stacks.size() > 2 ? fmt::format(" (and {} more kinds of names)", stacks.size() - 2) : "";
    if (other.size() == 1 && most.size() > 1)
        bad_file(folder, "{} is not named like the {} other slices ({} ...){}: move it elsewhere, or rename it if it is one of them",
                 other.front().name, most.size(), most.front().name, more);
    bad_file(folder, "{} file{} named like {}, {} like {}{}: put the slices of one stack into a folder of their own", most.size(),
             most.size() == 1 ? " is" : "s are", most.front().name, other.size(), other.front().name, more);
}

/// Whether the points in column `c` are not decimal points: 1.1, 1.2, ... 1.10.
bool counts_behind_point(const std::vector<NumberedName>& names, std::size_t c) {
    std::set<std::string> wholes;
    std::set<NameNumber> fractions;
    std::set<std::size_t> widths;
    for (const NumberedName& n : names) {
        if (n.numbers[c].fraction.empty()) return false;
        wholes.insert(n.numbers[c].whole);
        NameNumber fraction;
        fraction.whole = n.numbers[c].fraction;
        widths.insert(fraction.whole.size());
        fractions.insert(fraction);
    }
    if (wholes.size() > 1 || widths.size() == 1 || fractions.size() != names.size()) return false;
    return fractions.rbegin()->value() - fractions.begin()->value() + 1 == static_cast<double>(fractions.size());
}

/// "img_z" 0 to 7.
std::string range_text(const std::vector<NumberedName>& names, std::size_t c) {
    const auto less = [c](const NumberedName& a, const NumberedName& b) { return a.numbers[c] < b.numbers[c]; };
    const auto [least, most] = std::minmax_element(names.begin(), names.end(), less);
    return fmt::format("\"{}\" {} to {}", names.front().texts[c], least->numbers[c].text(), most->numbers[c].text());
}

void sort_by(std::vector<NumberedName>& names, std::size_t c) {
    std::stable_sort(names.begin(), names.end(), [c](const auto& a, const auto& b) { return a.numbers[c] < b.numbers[c]; });
}

/// Whether column `c` rises (1) or falls (-1) all along the names; else 0.
int trend(const std::vector<NumberedName>& names, std::size_t c) {
    bool rises = true, falls = true;
    for (std::size_t i = 1; i < names.size(); ++i) {
        rises &= names[i - 1].numbers[c] < names[i].numbers[c];
        falls &= names[i].numbers[c] < names[i - 1].numbers[c];
    }
    return rises ? 1 : falls ? -1 : 0;
}

/// Which number orders the names; they are sorted by it.
std::size_t order_names(const std::string& folder, std::vector<NumberedName>& names, SliceStack& stack) {
    std::vector<std::size_t> varying;
    for (std::size_t c = 0; c < names.front().numbers.size(); ++c) {
        std::set<NameNumber> values;
        for (const NumberedName& n : names) values.insert(n.numbers[c]);
        if (values.size() > 1) varying.push_back(c);
    }
    if (varying.empty())
        bad_file(folder, "{} and {} have the same number: expected one that orders the slices", names[0].name, names[1].name);
    sort_by(names, varying.front());
    if (varying.size() == 1) {
        const std::size_t c = varying.front();
        for (std::size_t i = 1; i < names.size(); ++i)
            if (!(names[i - 1].numbers[c] < names[i].numbers[c]))
                bad_file(folder, "{} and {} have the same number, {}: expected each slice once", names[i - 1].name, names[i].name,
                         names[i].numbers[c].text());
        return c;
    }
    std::string ranges;
    for (const std::size_t c : varying) ranges += (ranges.empty() ? "" : ", ") + range_text(names, c);
    const auto is_clear = [&](std::size_t c) { return trend(names, c) != 0; };
    if (!std::all_of(varying.begin(), varying.end(), is_clear))
        bad_file(folder, "several numbers vary in the names of its {} slices ({}): put the files of one stack into a folder of their own",
                 names.size(), ranges);
    (std::all_of(varying.begin(), varying.end(), [&](std::size_t c) { return trend(names, c) > 0; }) ? stack.decisions : stack.notes)
        .push_back(fmt::format("several numbers vary together in the names ({}): slices are ordered by the first", ranges));
    return varying.front();
}

/// Throws Error{input}, or notes with `allow_gaps`, where numbers are missing or the steps between them are uneven.
void check_steps(const std::string& folder, const std::vector<NumberedName>& names, std::size_t c, bool allow_gaps, SliceStack& stack) {
    if (names.size() < 3) return;
    // Numbers this long are dates or identifiers: their order counts, not their distance.
    constexpr std::size_t longest_count = 11;
    std::size_t decimals = 0;
    for (const NumberedName& n : names) {
        if (n.numbers[c].digits() > longest_count) return;
        decimals = std::max(decimals, n.numbers[c].fraction.size());
    }
    std::vector<double> steps;
    for (std::size_t i = 1; i < names.size(); ++i) steps.push_back(names[i].numbers[c].value() - names[i - 1].numbers[c].value());
    std::vector<double> sorted = steps;
    std::sort(sorted.begin(), sorted.end());
    const double step = sorted[(sorted.size() - 1) / 2], last_digit = std::pow(10.0, -static_cast<double>(decimals));
    const double tolerance = std::max(0.25 * step, 1.001 * last_digit); // names may be rounded
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const bool missing = steps[i] >= 1.75 * step;
        if (!missing && std::abs(steps[i] - step) <= tolerance) continue;
        const std::string a = names[i].name, b = names[i + 1].name;
        const std::string what =
            missing ? fmt::format("slice {:.{}f} is missing between {} and {}", names[i].numbers[c].value() + step, decimals, a, b)
                    : fmt::format("from {} to {} is a step of {:g}, elsewhere of {:g}", a, b, steps[i], step);
        if (!allow_gaps) bad_file(folder, "{}: --allow-gaps takes the slices that are there as neighbours", what);
        stack.notes.push_back(what + ": the slices that are there are taken as neighbours");
        return;
    }
}

} // namespace

SliceStack slice_stack(const std::string& folder, const std::vector<std::string>& files, bool allow_gaps) {
    SliceStack stack;
    stack.paths = files;
    if (files.size() < 2) return stack;
    std::vector<NumberedName> names = names_of_one_stack(folder, files);
    for (std::size_t c = 0; c < names.front().numbers.size(); ++c)
        if (counts_behind_point(names, c))
            for (NumberedName& n : names) n.numbers[c].whole = std::exchange(n.numbers[c].fraction, "");
    const std::size_t c = order_names(folder, names, stack);
    check_steps(folder, names, c, allow_gaps, stack);
    for (std::size_t i = 0; i < names.size(); ++i) stack.paths[i] = (std::filesystem::path(folder) / names[i].name).string();
    stack.decisions.push_back(fmt::format("order of slices from the names: {}", range_text(names, c)));
    return stack;
}

} // namespace clvr
