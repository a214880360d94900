// Numbers in the names of files.
#pragma once
#include <string>
#include <vector>

namespace clvr {

/// A number as it is spelled in a name: exact, of any length.
struct NameNumber {
    bool negative = false;
    std::string whole, fraction; ///< digits; `fraction` is empty where there is no point
    std::string text() const;    ///< as it is spelled, without plus
    double value() const;
    /// Significant digits; with more than 15, `value` is not exact.
    std::size_t digits() const;
};
/// By value.
bool operator<(const NameNumber& a, const NameNumber& b);

/// A name cut into texts and numbers.
struct NumberedName {
    std::string name;
    std::vector<std::string> texts; ///< in lower case; one more than numbers
    std::vector<NameNumber> numbers;
    std::string pattern() const; ///< the texts with # for each number: alike for files of one stack
};
/// Of a file's name, with the folders before it, without a picture's ending. A minus is a sign at the start and behind what is neither
/// letter nor digit; with `signs_after_letters` also behind a letter. A point between two numbers is a decimal one unless more points
/// follow or precede
/// ("1.2.840").
NumberedName numbered_name(const std::string& whole, bool signs_after_letters);

} // namespace clvr
