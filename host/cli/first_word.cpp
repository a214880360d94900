#include "host/cli/first_word.hpp"
#include "host/cli/open_volume.hpp"
#include "runtime/error.hpp"
#include "runtime/system/nearest.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace clvr {

namespace {

namespace fs = std::filesystem;

/// The file of "FILE:/path/inside", else the whole.
std::string file_of(const std::string& volume) {
    std::error_code failed;
    if (fs::exists(volume, failed)) return volume;
    const std::size_t inside = volume.find(":/");
    return inside == volume.npos ? volume : volume.substr(0, inside);
}

bool is_volume(const std::string& word) {
    std::error_code failed;
    return is_demo_volume(word) || (!word.empty() && fs::exists(file_of(word), failed));
}

bool is_option(const std::string& word) { return word.size() > 1 && word[0] == '-'; }

/// The option of the command that a word gives ("-o", "--output=x.png"); null: none.
const CLI::Option* option_of(const CLI::App& command, const std::string& word) {
    return command.get_option_no_throw(word.substr(0, word.find('=')));
}

/// The first word that is neither an option of the program nor the value of one.
std::size_t first_of(const CLI::App& program, const std::vector<std::string>& words) {
    std::size_t i = 0;
    while (i < words.size() && is_option(words[i])) {
        const CLI::Option* option = option_of(program, words[i]);
        if (!option) break;
        i += option->get_items_expected_max() > 0 && words[i].find('=') == std::string::npos ? 2 : 1;
    }
    return i;
}

bool is_number(const std::string& text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
}

/// Without a file's ending. UIDs end in numbers, which are no endings.
std::string without_ending(const fs::path& name) {
    const std::string ending = name.extension().string();
    if (ending.size() < 2 || is_number(ending.substr(1))) return name.string();
    const fs::path stem = name.stem();
    std::string inner = stem.extension().string();
    std::transform(inner.begin(), inner.end(), inner.begin(), [](unsigned char c) { return std::tolower(c); });
    const bool packed = ending == ".gz" || ending == ".GZ" || ending == ".bz2";
    return packed || inner == ".ome" ? without_ending(stem) : stem.string();
}

} // namespace

std::vector<std::string> with_command(const CLI::App& program, std::vector<std::string> words) {
    const std::size_t first = first_of(program, words);
    if (first >= words.size()) return words;
    std::vector<std::string> names;
    for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) names.push_back(command->get_name());
    const auto is_command = [&](const std::string& word) { return std::find(names.begin(), names.end(), word) != names.end(); };
    const std::string& word = words[first];
    if (is_command(word)) return words;
    const bool of_render =
        is_option(word) && option_of(*program.get_subcommand("render"), word) && std::none_of(words.begin(), words.end(), is_command);
    if (of_render || is_volume(word)) {
        words.insert(words.begin() + static_cast<std::ptrdiff_t>(first), {"render", "--beside"});
        return words;
    }
    if (is_option(word)) return words; // CLI11 refuses it
    if (word.find_first_of("./\\") != std::string::npos) throw Error(ErrorKind::input, "does not exist", word);
    const std::string near = nearest_name(word, names);
    throw Error(ErrorKind::usage,
                "there is no command or file \"" + word + "\"" + (near.empty() ? " (see clvr --help)" : ": did you mean " + near + "?"));
}

std::string picture_beside(const std::string& volume) {
    if (is_demo_volume(volume)) return volume.substr(volume.find(':') + 1) + ".png";
    std::error_code failed;
    fs::path path(file_of(volume));
    const bool folder = fs::is_directory(path, failed);
    const std::string last = path.filename().string();
    if (folder && (last == "." || last == "..")) path = fs::canonical(path, failed);
    if (!path.has_filename()) path = path.parent_path(); // scans/
    if (!path.has_filename()) throw Error(ErrorKind::usage, "has no name for a picture beside it: add -o picture.png", volume);
    const std::string name = folder ? path.filename().string() : without_ending(path.filename());
    return (path.parent_path() / (name + ".png")).string();
}

} // namespace clvr
