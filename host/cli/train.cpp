// clvr train: folders of pairs to a model.
#include "host/cli/commands.hpp"
#include "host/cli/device_options.hpp"
#include "host/cli/file_options.hpp"
#include "host/cli/progress_bar.hpp"
#include "host/io/model/model_file.hpp"
#include "host/train/trainer.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"
#include "runtime/system/signals.hpp"

#include <cstdio>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace clvr {

namespace {

struct TrainOptions {
    std::vector<std::string> folders, channels, levels;
    std::string output, init, validate, loss = "shifted-gamma", target = "reference", schedule = "constant", convolution = "direct";
    TrainerConfig trainer;
    int hidden = 20, kernel = 5;
    bool resume = false, no_augment = false, plain = false, no_demodulation = false, no_opacity_weight = false, control_variate = false;
    DeviceOptions device;
};

constexpr std::pair<const char*, Loss> losses[] = {{"shifted-gamma", Loss::shifted_gamma},
                                                   {"shifted-gamma-l2", Loss::shifted_gamma_l2},
                                                   {"shifted-gamma-bands", Loss::shifted_gamma_bands},
                                                   {"reference", Loss::reference},
                                                   {"smape", Loss::smape},
                                                   {"relative-l2", Loss::relative_l2}};

/// "shifted-gamma, ..., smape or relative-l2".
std::string loss_names() {
    std::string names;
    for (const auto& [name, loss] : losses)
        names += (names.empty() ? "" : name == std::end(losses)[-1].first ? " or " : ", ") + std::string(name);
    return names;
}

Loss loss_of(const TrainOptions& o) {
    if (o.target == "noisy") return Loss::noisy;
    if (o.target != "reference") throw Error(ErrorKind::usage, fmt::format("is \"{}\"; expected reference or noisy", o.target), "--target");
    for (const auto& [name, loss] : losses)
        if (o.loss == name) return loss;
    throw Error(ErrorKind::usage, fmt::format("is \"{}\"; expected {}", o.loss, loss_names()), "--loss");
}

/// "PIXELS:CODES".
Model::Level level_of(const std::string& text) {
    Model::Level level;
    int end = 0;
    if (std::sscanf(text.c_str(), "%d:%d%n", &level.pixels, &level.codes, &end) == 2 && static_cast<std::size_t>(end) == text.size())
        return level;
    throw Error(ErrorKind::usage, fmt::format("has \"{}\"; expected PIXELS:CODES, as 4:4", text), "--levels");
}

Model start_of(const TrainOptions& o) {
    if (!o.init.empty()) {
        for (const auto& [name, given] : {std::pair("--channels", &o.channels), {"--levels", &o.levels}})
            if (!given->empty()) throw Error(ErrorKind::usage, "is set by the model of --init; leave one of them out", name);
        Model m = read_model(o.init);
        if (o.control_variate) add_known_light(m);
        return m;
    }
    Model m = o.plain ? Model() : default_settings();
    if (!o.channels.empty()) m.channels = o.channels;
    if (m.channels.empty()) m.channels = reference_channels();
    if (!o.levels.empty()) {
        m.levels.clear();
        for (const auto& text : o.levels) m.levels.push_back(level_of(text));
        try {
            validate_levels(m.levels);
        } catch (const Error& e) {
            throw Error(ErrorKind::usage, e.what(), "--levels");
        }
    }
    m.hidden = o.hidden;
    m.kernel = o.kernel;
    if (o.no_demodulation) m.demodulation = false;
    if (o.no_opacity_weight) m.opacity_weight = false;
    if (m.hidden < 1 || m.hidden > 256) throw Error(ErrorKind::usage, fmt::format("is {}; expected 1 to 256", m.hidden), "--hidden");
    if (m.kernel < 1 || m.kernel > 15 || m.kernel % 2 == 0)
        throw Error(ErrorKind::usage, fmt::format("is {}; expected an odd number, 1 to 15", m.kernel), "--kernel");
    initialise(m, o.trainer.seed);
    if (o.control_variate) add_known_light(m);
    return m;
}

void check(const TrainOptions& o) {
    const auto range = [](const char* name, double value, double low, double high) {
        if (!(value >= low && value <= high))
            throw Error(ErrorKind::usage, fmt::format("is {}; expected {} to {}", value, low, high), name);
    };
    if (o.folders.empty()) throw Error(ErrorKind::usage, "no folder given: name one that `clvr pairs` made", "clvr train");
    if (o.output.empty()) throw Error(ErrorKind::usage, "no output given: add -o model.safetensors", "clvr train");
    range("--epochs", o.trainer.epochs, 1, 1e6);
    range("--steps", static_cast<double>(o.trainer.steps), 0, 1e9);
    range("--batch", o.trainer.step.batch, 1, 65536);
    range("--patch", o.trainer.step.patch, 1, 4096);
    range("--patches-per-image", o.trainer.patches_per_image, 1, 1e6);
    range("--micro-batch", o.trainer.step.micro_batch, 0, 65536);
    range("--lr", o.trainer.learning_rate, 1e-12, 10);
    range("--clip-norm", o.trainer.step.clip_norm, 0, 1e12);
    if (o.convolution != "direct" && o.convolution != "clblast")
        throw Error(ErrorKind::usage, fmt::format("is \"{}\"; expected direct or clblast", o.convolution), "--conv");
    if (o.schedule != "constant" && o.schedule != "cosine")
        throw Error(ErrorKind::usage, fmt::format("is \"{}\"; expected constant or cosine", o.schedule), "--schedule");
}

void train(TrainOptions o) {
    check(o);
    o.trainer.step.loss = loss_of(o);
    o.trainer.step.convolution = o.convolution == "clblast" ? ConvolutionBackend::clblast : ConvolutionBackend::direct;
    o.trainer.cosine = o.schedule == "cosine";
    o.trainer.augment = !o.no_augment;
    check_writable(o.output);
    const Model model = start_of(o);
    const std::atomic<bool>& interrupted = catch_interrupts();
    Trainer trainer(open_devices(o.device), model, o.trainer, o.folders, o.validate, o.output, o.resume);
    bool finished = false;
    {
        ProgressBar bar("training", false);
        finished = trainer.run(interrupted, [&](const TrainerProgress& p) {
            const std::string of = o.trainer.steps > 0 ? "" : fmt::format("/{}", o.trainer.epochs);
            std::string note = fmt::format("epoch {}{}, loss {:.5f}", p.epoch, of, p.loss);
            if (p.validation > 0) note += fmt::format(", {:.2f} dB", p.validation);
            bar.update(p.done, note);
        });
    }
    print_profiles(o.device, trainer.devices());
    if (!trainer.records().empty()) {
        const EpochRecord& last = trainer.records().back();
        spdlog::info("{} epochs, loss {:.6f}{}", trainer.records().size(), last.loss,
                     last.validation > 0 ? fmt::format(", validation {:.2f} dB", last.validation) : "");
    }
    if (!finished) throw Error(ErrorKind::interrupted, "interrupted; saved, continue with --resume");
}

} // namespace

void add_train_command(CLI::App& app) {
    CLI::App* c = app.add_subcommand("train", "Train a denoiser on folders that `clvr pairs` made");
    auto o = std::make_shared<TrainOptions>();
    TrainerConfig& t = o->trainer;
    c->add_option("DIR", o->folders, "Folders of training pairs")->type_name("DIR");
    c->add_option("-o,--output", o->output, "Model to write (.safetensors); beside it .last.safetensors, .checkpoint and .training.csv")
        ->type_name("FILE")
        ->group("Output");
    c->add_flag("--resume", o->resume, "Go on from the checkpoint: the same bits as without the interruption")->group("Output");
    c->add_option("--validate", o->validate, "Folder of test pairs: the best model on its frames is kept")
        ->type_name("DIR")
        ->group("Training");
    c->add_option("--init", o->init, "Begin with this model's weights and settings; default: the one inside clvr")
        ->type_name("default|FILE")
        ->group("Training");
    c->add_option("--epochs", t.epochs, "How often each view is seen [200]")->group("Training");
    c->add_option("--steps", t.steps, "End after so many steps; 0: with the last epoch [0]")->group("Training");
    c->add_option("--batch", t.step.batch, "Patches a step [128]")->group("Training");
    c->add_option("--patch", t.step.patch, "Width and height of a patch [256]")->group("Training");
    c->add_option("--patches-per-image", t.patches_per_image, "Patches of each view an epoch [50]")->group("Training");
    c->add_option("--lr", t.learning_rate, "Learning rate of Adam [0.0001]")->group("Training");
    c->add_option("--schedule", o->schedule, "Of the learning rate: the same throughout, or falling along a cosine [constant]")
        ->type_name("constant|cosine")
        ->group("Training");
    c->add_option("--clip-norm", t.step.clip_norm, "Greatest norm of a gradient; 0: not clipped [0]")->group("Training");
    c->add_option("--loss", o->loss, "What training makes small: " + loss_names() + " [shifted-gamma]")
        ->type_name("LOSS")
        ->group("Training");
    c->add_option("--target", o->target, "The reference, or another noisy frame of the view [reference]")
        ->type_name("reference|noisy")
        ->group("Training");
    c->add_flag("--no-augment", o->no_augment, "Without the 8 dihedral transforms")->group("Training");
    c->add_option("--seed", t.seed, "Of initialisation and patches [0]")->group("Training");
    c->add_option("--conv", o->convolution,
                  "Convolutions: by clvr's kernels, the same bits on every device, or by im2col and CLBlast's SGEMM [direct]")
        ->type_name("direct|clblast")
        ->group("Training");
    c->add_option("--micro-batch", t.step.micro_batch, "Patches on the device at once; 0: what fits [0]")->group("Training");
    c->add_option("--channels", o->channels,
                  "Input channels by their names in frames, joined by commas [all that clvr renders and \"noise\"; with --plain R, G, B, "
                  "albedo, normal, depth]")
        ->delimiter(',')
        ->type_name("NAME,...")
        ->group("Model");
    c->add_option("--hidden", o->hidden, "Hidden channels [20]")->group("Model");
    c->add_option("--kernel", o->kernel, "Size of the convolutions [5]")->group("Model");
    c->add_option("--levels", o->levels,
                  "Bilateral grids, the finest first: pixels of a cell each way and codes (of the guide's 256) of a cell [4:4,8:8,16:16]")
        ->delimiter(',')
        ->type_name("PIXELS:CODES,...")
        ->group("Model");
    c->add_flag("--plain", o->plain, "Without exposure, albedo floor and opacity weights: the reference's preprocessing")->group("Model");
    c->add_flag("--no-demodulation", o->no_demodulation, "Without dividing the radiance by the albedo")->group("Model");
    c->add_flag("--no-opacity-weight", o->no_opacity_weight, "Without weights by opacity.A, which other renderers' files lack")
        ->group("Model");
    c->add_flag("--control-variate", o->control_variate,
                "Take the light that is known without noise off before the filter and add it after; read it as three channels more")
        ->group("Model");
    c->footer("Examples:\n"
              "  clvr train pairs -o mine.safetensors --init default --patch 128 --batch 8 --epochs 40\n"
              "  clvr train a b c -o mine.safetensors --validate test\n"
              "  clvr train pairs -o mine.safetensors --resume\n");
    add_device_options(*c, o->device, "train");
    reads_files(*c, {"DIR", "--validate", "--init"});
    writes_files(*c, "--output", training_files);
    c->callback([o] { train(*o); });
}

} // namespace clvr
