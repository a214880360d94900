#include "host/experiment/ablation.hpp"
#include "host/eval/evaluation_json.hpp"
#include "host/experiment/stage_times.hpp"
#include "host/io/model/model_file.hpp"
#include "host/io/picture/frame_file.hpp"
#include "host/io/settled_folder.hpp"
#include "host/pairs/folder.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"
#include "runtime/system/hashes.hpp"
#include "runtime/system/json_text.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace clvr {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

/// The rows asked for, in the order of ablation_rows.
std::vector<AblationRow> chosen(const std::vector<std::string>& names) {
    std::vector<AblationRow> rows;
    for (const std::string& name : names) {
        std::vector<std::string> known;
        for (const AblationRow& row : ablation_rows()) known.push_back(row.name);
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw Error(ErrorKind::usage, fmt::format("has \"{}\"; expected some of {}", name, fmt::join(known, ", ")), "--rows");
    }
    for (const AblationRow& row : ablation_rows())
        if (names.empty() ? row.standard : std::find(names.begin(), names.end(), row.name) != names.end()) rows.push_back(row);
    return rows;
}

/// A folder that is measured, and its noisy frame of each number of samples per pixel.
struct Test {
    std::string folder, name;
    std::vector<int> frames;
};

/// The folder's own name, with or without a slash behind it.
std::string name_of(const std::string& folder) { return (fs::path(folder) / "").parent_path().filename().string(); }

std::vector<Test> tests_of(const AblationSettings& s) {
    std::vector<Test> tests;
    for (const std::string& folder : s.test) {
        const PairsFolder pairs = read_pairs(folder);
        if (pairs.views.front().reference.empty()) throw Error(ErrorKind::input, "has no references to measure against", folder);
        Test test{folder, name_of(folder), {}};
        for (const int spp : s.spp) {
            const auto at = std::find(pairs.spp.begin(), pairs.spp.end(), spp);
            if (at == pairs.spp.end())
                throw Error(ErrorKind::input,
                            fmt::format("has no noisy frames of {} samples per pixel, but of {}", spp, fmt::join(pairs.spp, ", ")), folder);
            test.frames.push_back(static_cast<int>(at - pairs.spp.begin()));
        }
        tests.push_back(test);
    }
    for (Test& test : tests) // whole paths where two names are the same
        if (std::count_if(tests.begin(), tests.end(), [&](const Test& other) { return name_of(other.folder) == name_of(test.folder); }) > 1)
            test.name = test.folder;
    return tests;
}

/// The settings that all rows share. Folders count by their content, as they may move.
std::string shared_settings(const AblationSettings& s) {
    const auto contents = [](const std::vector<std::string>& folders) {
        ordered_json all = ordered_json::array();
        for (const std::string& folder : folders) {
            read_pairs(folder); // throws where the folder is not complete
            all.push_back(sha256_hex(read_text((fs::path(folder) / "pairs.json").string())));
        }
        return all;
    };
    const TrainerConfig& t = s.training;
    return ordered_json{{format_key, "ablation/1"},
                        {"train", contents(s.train)},
                        {"test", contents(s.test)},
                        {"steps", t.steps},
                        {"batch", t.step.batch},
                        {"patch", t.step.patch},
                        {"learning_rate", t.learning_rate},
                        {"schedule", t.cosine ? "cosine" : "constant"},
                        {"seed", t.seed}}
               .dump(1) +
           "\n";
}

/// Checks, before anything is written, that patches fit into the pictures of each folder (which all have one size).
void check_patches(const AblationSettings& s) {
    for (const std::string& folder : s.train) {
        const Frame first = read_exr(read_pairs(folder).views.front().noisy.front());
        if (s.training.step.patch > std::min(first.width, first.height))
            throw Error(ErrorKind::usage,
                        fmt::format("is {}; the pictures of {} have {}x{} pixels, which is the most", s.training.step.patch, folder,
                                    first.width, first.height),
                        "--patch");
    }
}

void begin_ablation_folder(const std::string& settings, const std::string& folder) {
    begin_settled_folder(folder, "settings.json", settings,
                         "holds an ablation of other pairs or settings (its settings.json has them); name another folder");
}

/// The scores in a row's file; none where it is absent.
std::vector<AblationScore> read_scores(const std::string& path) {
    std::vector<AblationScore> scores;
    if (!fs::exists(path)) return scores;
    try {
        for (const auto& s : ordered_json::parse(read_text(path)).at("scores"))
            scores.push_back({s.at("test").get<std::string>(), s.at("spp").get<int>(), parse_metrics(s.at("mean"))});
        return scores;
    } catch (const nlohmann::json::exception& e) {
        throw Error(ErrorKind::input, fmt::format("is damaged ({}); remove it to measure again", e.what()), path);
    }
}

ordered_json json_of(const std::vector<AblationScore>& scores) {
    ordered_json all = ordered_json::array();
    for (const AblationScore& s : scores) all.push_back({{"test", s.test}, {"spp", s.spp}, {"mean", to_json(s.mean)}});
    return all;
}

/// The scores of a candidate for all tests and samples per pixel: read from its file, and measured where the file lacks some.
std::vector<AblationScore> scores_of(const Candidate& candidate, const std::vector<Test>& tests, const std::vector<int>& spp,
                                     const std::string& path, const std::function<void()>& seen) {
    std::vector<AblationScore> known = read_scores(path), wanted;
    for (std::size_t k = 0; k < spp.size(); ++k)
        for (const Test& test : tests) {
            const auto at =
                std::find_if(known.begin(), known.end(), [&](const AblationScore& s) { return s.test == test.name && s.spp == spp[k]; });
            if (at != known.end()) {
                wanted.push_back(*at);
                continue;
            }
            const Evaluation e = evaluate({candidate}, test.folder, test.frames[k], [&](double) { seen(); });
            wanted.push_back({test.name, spp[k], e.scores.front().mean});
            known.push_back(wanted.back());
            write_atomically(path, json_text(ordered_json{{"scores", json_of(known)}}));
        }
    return wanted;
}

} // namespace

const std::vector<AblationRow>& ablation_rows() {
    static const std::vector<AblationRow> rows = [] {
        std::vector<AblationRow> all;
        Model m = default_settings();
        m.opacity_weight = false;
        m.channels.clear();
        const auto add = [&](const std::string& name, const std::string& title, const auto& channels) {
            m.channels.insert(m.channels.end(), channels.begin(), channels.end());
            all.push_back({name, title, true, m});
        };
        add("colour", "colour only", channel::colour);
        add("albedo", "+ albedo", channel::albedo);
        add("normal", "+ normal", channel::normal);
        add("depth", "+ depth", std::array{channel::depth});
        add("opacity", "+ opacity, deviation, half depth: full set",
            std::array{channel::opacity, channel::depth_deviation, channel::depth_half});
        Model other = m;
        other.demodulation = false;
        all.push_back({"no-demodulation", "full set without demodulation", true, other});
        other = m;
        other.opacity_weight = true;
        all.push_back({"opacity-weight", "full set with opacity-weighted splat", true, other});
        Model noise = m;
        noise.channels.push_back("noise");
        all.push_back({"noise", "full set with noise level", true, noise});
        noise.opacity_weight = true;
        all.push_back({"opacity-weight-noise", "full set with both of these", false, noise});
        Model light = noise;
        light.channels.insert(light.channels.end(), {"known.R", "known.G", "known.B"});
        all.push_back({"known-light-channels", "with both and known light as channels", false, light});
        light.control_variate = true;
        all.push_back({"known-light", "with both and known light taken off, too", false, light});
        return all;
    }();
    return rows;
}

TrainerConfig ablation_training() {
    TrainerConfig t;
    t.steps = 1500;
    t.step.batch = 8;
    t.step.patch = 128;
    t.learning_rate = 1e-3;
    t.cosine = true;
    return t;
}

std::vector<std::string> ablation_files(const std::string& folder) {
    const auto path = [&](const std::string& name) { return (fs::path(folder) / name).string(); };
    std::vector<std::string> files = {path("settings.json"), path("stages.json"), path("ablation.json"), path("ablation.md"),
                                      path("noisy.json")};
    for (const AblationRow& row : ablation_rows()) {
        const std::vector<std::string> training = training_files(path(row.name + ".safetensors"));
        files.insert(files.end(), training.begin(), training.end());
        files.push_back(path(row.name + ".json"));
    }
    return files;
}

std::vector<AblationResult> run_ablation(const AblationSettings& s, const std::string& folder, const Device& device,
                                         const Provenance& provenance, const ExperimentControl& control) {
    const std::vector<AblationRow> rows = chosen(s.rows);
    const std::string settings = shared_settings(s);
    const std::vector<Test> tests = tests_of(s);
    check_patches(s);
    begin_ablation_folder(settings, folder);
    const auto path = [&](const std::string& name) { return (fs::path(folder) / name).string(); };
    StageTimes times(path("stages.json"));

    std::vector<AblationResult> results;
    ordered_json json_rows = ordered_json::array();
    const auto measure = [&](const std::string& name, const std::string& title, const Candidate& candidate, double seconds_per_step) {
        results.push_back({title,
                           scores_of(candidate, tests, s.spp, path(name + ".json"),
                                     [&] {
                                         control.progress("measuring " + title, 0, "");
                                         if (control.interrupted)
                                             throw Error(ErrorKind::interrupted, "interrupted; the same command goes on from here");
                                     }),
                           seconds_per_step});
        ordered_json row{{"name", name}, {"title", title}};
        if (seconds_per_step > 0) row["seconds_per_step"] = seconds_per_step;
        row["scores"] = json_of(results.back().scores);
        json_rows.push_back(row);
    };
    measure("noisy", "noisy input", noisy_input(), 0);
    for (const AblationRow& row : rows) {
        const std::string model = path(row.name + ".safetensors");
        if (!times.finished(row.name) || !fs::exists(model)) {
            Model start = row.model;
            initialise(start, s.training.seed);
            const bool done = times.time(row.name, [&] {
                control.progress("training " + row.title, 0, "reading");
                Trainer trainer(device, start, s.training, s.train, "", model, fs::exists(path(row.name + ".checkpoint")));
                return trainer.run(control.interrupted, [&](const TrainerProgress& p) {
                    control.progress("training " + row.title, p.done, fmt::format("loss {:.5f}", p.loss));
                });
            });
            if (!done) throw Error(ErrorKind::interrupted, "interrupted; the same command goes on from here");
            times.finish(row.name);
        }
        measure(row.name, row.title, through_model(device, row.name, read_model(model)),
                times.seconds(row.name) / static_cast<double>(s.training.steps));
    }

    ordered_json all{{format_key, "ablation-results/1"}, {"device", device.facts().name}, {"version", provenance.version}};
    if (!provenance.commit.empty()) all["commit"] = provenance.commit;
    all.update({{"command", provenance.command}, {"settings", ordered_json::parse(settings)}, {"rows", json_rows}});
    write_atomically(path("ablation.json"), json_text(all));
    const TrainerConfig& t = s.training;
    write_atomically(
        path("ablation.md"),
        fmt::format(
            "# Feature ablation\n\n{} steps of {} patches of {}x{} each, on {} folders of pairs. Rows 1 to 5 add up; the others change "
            "the full set.\n\n{}\n`{}`, clvr {}{}, {}\n",
            t.steps, t.step.batch, t.step.patch, t.step.patch, s.train.size(), markdown_tables(results), provenance.command,
            provenance.version, provenance.commit.empty() ? "" : " at " + provenance.commit, device.facts().name));
    return results;
}

} // namespace clvr
