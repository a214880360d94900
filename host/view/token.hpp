// The secret that whoever uses a viewer has to know.
#pragma once
#include <string>

namespace clvr::view {

/// 256 random bits from the operating system, as 64 hexadecimal digits. Throws Error{internal} where there are none.
std::string new_token();
/// Whether two texts are the same, in a time that depends on their lengths alone.
bool same_token(const std::string& a, const std::string& b);
/// Writes the token, with a newline, to a file that only its owner may read. Throws Error{input}.
void write_token_file(const std::string& path, const std::string& token);

} // namespace clvr::view
