// Writes the samples of every fuzz target into FOLDER/TARGET/, and the words in them as libFuzzer's dictionary FOLDER/TARGET.dict.
#include "tests/fuzz/samples.hpp"

#include <cctype>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>

namespace {

namespace fs = std::filesystem;

/// Runs of 3 to 40 letters, digits, '_', '.', ':' and '-' that hold a letter.
void add_words(const std::string& bytes, std::set<std::string>& words) {
    std::string word;
    for (const char c : bytes + '\0') {
        const auto u = static_cast<unsigned char>(c);
        if (u < 128 && (std::isalnum(u) || (c != '\0' && std::string("_.:-").find(c) != std::string::npos))) {
            word += c;
            continue;
        }
        bool letter = false;
        for (const char w : word) letter = letter || std::isalpha(static_cast<unsigned char>(w));
        if (letter && word.size() >= 3 && word.size() <= 40) words.insert(word);
        word.clear();
    }
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: clvr_fuzz_corpus FOLDER\n";
        return 2;
    }
    for (const auto& target : clvr::test::fuzz_targets()) {
        const fs::path folder = fs::path(argv[1]) / target.name;
        fs::create_directories(folder);
        std::set<std::string> words;
        for (const auto& sample : clvr::test::fuzz_samples(target)) {
            std::ofstream(folder / sample.name, std::ios::binary) << sample.bytes;
            add_words(sample.bytes, words);
        }
        std::ofstream dictionary(folder.string() + ".dict");
        dictionary << "\"\\x0A--8<--\\x0A\"\n"; // file_mark
        for (const std::string& word : words) dictionary << '"' << word << "\"\n";
    }
    return 0;
}
