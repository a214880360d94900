// Words and numbers of text headers.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clvr {

std::string_view trimmed(std::string_view s);
std::string lower_case(std::string_view s);
/// The numbers of a text, separated by blanks, commas or parentheses ("nan" and "inf" are numbers); nothing when a word is none.
std::optional<std::vector<double>> parse_numbers(std::string_view text);
/// `count` whole numbers of at least `least`. Throws Error{input} naming file and field.
std::vector<std::int64_t> parse_integers(std::string_view text, std::size_t count, std::int64_t least, const char* field,
                                         const std::string& path);
/// `count` finite numbers. Throws Error{input} naming file and field.
std::vector<double> parse_finite(std::string_view text, std::size_t count, const char* field, const std::string& path);
/// `count` voxel sizes, all finite and not 0. Throws Error{input} naming file and field.
std::vector<double> parse_spacing(std::string_view text, std::size_t count, const char* field, const std::string& path);
/// The path of a file that a header names, relative to the header's folder: by the exact name, else by the only name that differs in case
/// alone; "\\" separates folders where no file has it in its name. Throws Error{input} when there is none.
std::string beside(const std::string& header, const std::string& name);

} // namespace clvr
