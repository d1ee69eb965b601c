// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <xtrack/method.hpp>
#include <xtrack/pattern.hpp>

#include "core/base/file.hpp"
#include "core/capture/image_codec.hpp"
#include "core/capture/yaml_file.hpp"
#include "tools/commands.hpp"
#include "tools/image_size.hpp"
#include "tools/interrupt.hpp"
#include "tools/light_report.hpp"
#include "tools/light_source.hpp"
#include "tools/method_choice.hpp"
#include "tools/stream.hpp"

namespace xtrack::tools {

namespace {

namespace fs = std::filesystem;

constexpr const char* kRigFile = "rig.yaml";
constexpr const char* kPatternFile = "pattern.yaml";

struct LightOptions {
    std::string source;
    std::string out;
    bool json = false;
};

struct PatternOptions {
    std::string out;
    std::string size;
    std::string axis = "x";
    std::string from;
    int levels = 18;
};

bool is_there(const fs::path& path) {
    std::error_code error;
    return fs::exists(path, error);
}

Error of_another_projector(const fs::path& file, Size has, Size measured) {
    return {ErrorCode::invalid_argument,
            fmt::format("{}: projector_size is {}x{}, but {}x{} was measured; give the files of "
                        "this projector",
                        file.string(), has.width, has.height, measured.width, measured.height)};
}

// Puts what was measured into a rig.yaml that is there.
Result<std::string> in_rig_file(const fs::path& file, const CalibratedLight& found) {
    const LightCalibration& light = found.light;
    if (!light.colour) {
        return Error{ErrorCode::unsupported,
                     file.string() +
                         ": no colours were measured that it could hold; record colour "
                         "fringes in colour"};
    }
    const auto bytes = base::read_file(file, capture::kMaxYamlBytes);
    if (!bytes) {
        return bytes.error();
    }
    auto rig = capture::parse_rig(*bytes, file.string());
    if (!rig) {
        return rig.error();
    }
    if (rig->rig.projector && rig->rig.projector->size != found.patterns.projector_size) {
        return of_another_projector(file, rig->rig.projector->size, found.patterns.projector_size);
    }
    rig->rig.camera_from_projector_rgb = light.colour->camera_from_projector_rgb;
    return capture::rig_text(*rig);
}

Result<std::string> in_pattern_file(const fs::path& file, const CalibratedLight& found) {
    const LightCalibration& light = found.light;
    if (!light.response) {
        return Error{ErrorCode::unsupported,
                     file.string() +
                         ": no response was measured that it could hold; record a ramp "
                         "of grey levels"};
    }
    const auto bytes = base::read_file(file, capture::kMaxYamlBytes);
    if (!bytes) {
        return bytes.error();
    }
    auto patterns = capture::parse_patterns(*bytes, file.string());
    if (!patterns) {
        return patterns.error();
    }
    if (patterns->projector_size != found.patterns.projector_size) {
        return of_another_projector(file, patterns->projector_size, found.patterns.projector_size);
    }
    patterns->response = light.response->response;
    patterns->gamma.reset();  // the curve says it better
    return capture::patterns_text(*patterns);
}

// A new folder of what the source showed, with what was measured.
Result<std::vector<std::string>> write_folder(const fs::path& target, CalibratedLight found) {
    auto folder = base::NewFolder::create(target);
    if (!folder) {
        return folder.error();
    }
    std::vector<std::string> written;
    const auto write = [&](const char* name, const std::string& text) {
        written.push_back((target / name).string());
        return folder->write(name, text);
    };
    if (found.light.response) {
        found.patterns.response = found.light.response->response;
    }
    auto ok = write(kPatternFile, capture::patterns_text(found.patterns));
    if (ok && found.rig) {
        if (found.light.colour) {
            found.rig->camera_from_projector_rgb = found.light.colour->camera_from_projector_rgb;
        }
        ok = write(kRigFile, capture::rig_text({*found.rig, {}}));
    }
    if (ok) {
        ok = folder->commit();
    }
    if (!ok) {
        return ok.error();
    }
    return written;
}

// Into the files that are there, each whole or not at all.
Result<std::vector<std::string>> write_files(const fs::path& out, const CalibratedLight& found) {
    const LightCalibration& light = found.light;
    std::error_code error;
    std::vector<fs::path> files;
    if (fs::is_directory(out, error)) {
        for (const char* name : {kRigFile, kPatternFile}) {
            const bool measured =
                name == kRigFile ? light.colour.has_value() : light.response.has_value();
            if (measured && is_there(out / name)) {
                files.push_back(out / name);
            }
        }
        if (files.empty()) {
            return Error{ErrorCode::not_found,
                         out.string() +
                             ": holds neither a rig.yaml for the colours nor a "
                             "pattern.yaml for the response that were measured; give the folder "
                             "of a rig, or a new one"};
        }
    } else {
        files.push_back(out);
    }
    // Both texts are made before one of them is written.
    std::vector<std::string> texts;
    for (const fs::path& file : files) {
        auto text =
            file.filename() == kRigFile ? in_rig_file(file, found) : in_pattern_file(file, found);
        if (!text) {
            return text.error();
        }
        texts.push_back(*std::move(text));
    }
    std::vector<std::string> written;
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (auto ok = base::write_file(files[i], texts[i]); !ok) {
            return ok.error();
        }
        written.push_back(files[i].string());
    }
    return written;
}

// What can be said of --out before anything is measured.
Result<void> check_out(const LightOptions& options) {
    const fs::path out = options.out;
    const bool named = out.filename() == kRigFile || out.filename() == kPatternFile;
    const auto refuse = [&](const char* why) {
        return Error{ErrorCode::invalid_argument, "--out " + options.out + why};
    };
    std::error_code error;
    if (is_there(out)) {
        return fs::is_directory(out, error) || named
                   ? Result<void>()
                   : refuse(": give a folder, a rig.yaml or a pattern.yaml");
    }
    if (named) {
        return refuse(": is not there to be updated; give one that is, or a new folder");
    }
    const fs::path parent = fs::absolute(out, error).parent_path();
    return fs::is_directory(parent, error)
               ? Result<void>()
               : refuse(": its parent folder is missing; make it first");
}

// What was measured and has no place among the files: it must not be lost in silence.
void print_unkept(const LightCalibration& light, const std::vector<std::string>& written) {
    const auto kept = [&](const char* name) {
        return std::any_of(written.begin(), written.end(), [&](const std::string& file) {
            return fs::path(file).filename() == name;
        });
    };
    if (light.colour && !kept(kRigFile)) {
        fmt::print(stderr,
                   "xtrack: the matrix of the colours was not stored, for want of a rig.yaml; give "
                   "one with --out, or write the matrix into it (camera_from_projector_rgb)\n");
    }
    if (light.response && !kept(kPatternFile)) {
        fmt::print(stderr,
                   "xtrack: the response was not stored, for want of a pattern.yaml; give one with "
                   "--out\n");
    }
}

int calibrate_light(const LightOptions& options) {
    const bool simulated = is_simulator(options.source);
    if (simulated) {
        if (const auto preset = preset_of(options.source); !preset) {
            return usage(preset.error());
        }
    }
    const fs::path out = options.out;
    if (!options.out.empty()) {
        if (const auto possible = check_out(options); !possible) {
            return usage(possible.error());
        }
    }
    auto found = simulated ? light_of_simulation(*preset_of(options.source))
                           : light_of_recording(options.source);
    if (!found) {
        return fail(found.error());
    }
    const bool good = !found->light.colour || found->light.colour->passed;
    std::vector<std::string> written;
    if (good && !options.out.empty()) {
        auto files = is_there(out) ? write_files(out, *found) : write_folder(out, *found);
        if (!files) {
            return fail(files.error());
        }
        written = *std::move(files);
    }
    if (options.json) {
        std::fputs(light_json(found->light, written).c_str(), stdout);
    } else {
        std::fputs(light_text(found->light).c_str(), stdout);
        for (const std::string& file : written) {
            fmt::print("written: {}\n", file);
        }
    }
    if (good && !options.out.empty()) {
        print_unkept(found->light, written);
    }
    if (!good && !options.out.empty()) {
        return fail({ErrorCode::unsupported, "colours failed; nothing was written"});
    }
    return good ? 0 : 1;
}

// The sequence that is drawn, and how.
Result<PatternSequence> chosen_patterns(const PatternOptions& options, GammaCompensation& gamma) {
    if (options.from.empty()) {
        const auto size = parse_size(options.size);
        if (!size) {
            return Error{
                ErrorCode::invalid_argument,
                fmt::format(
                    "--size: '{}' is none; give the projector's, such as 1280x720, up to {} "
                    "a side, or a sequence with --from",
                    options.size, kMaxImageSide_px)};
        }
        auto sequence =
            light_sequence(options.axis == "x" ? Axis::x : Axis::y, *size, options.levels);
        if (!validate(sequence)) {
            return Error{ErrorCode::invalid_argument,
                         "--size " + options.size + ": is too small for the fringes"};
        }
        return sequence;
    }
    const auto bytes = base::read_file(options.from, capture::kMaxYamlBytes);
    if (!bytes) {
        return bytes.error();
    }
    auto patterns = capture::parse_patterns(*bytes, options.from);
    if (patterns && (patterns->response || patterns->gamma.value_or(1.0) != 1.0)) {
        gamma = GammaCompensation::precompensate;
    }
    return patterns;
}

int write_patterns(const PatternOptions& options) {
    GammaCompensation gamma = GammaCompensation::none;
    auto patterns = chosen_patterns(options, gamma);
    if (!patterns) {
        return patterns.error().code == ErrorCode::invalid_argument ? usage(patterns.error())
                                                                    : fail(patterns.error());
    }
    auto folder = base::NewFolder::create(options.out);
    if (!folder) {
        return fail(folder.error());
    }
    const NoteInterrupt note;
    Image<std::uint8_t> image;
    for (std::size_t i = 0; i < patterns->patterns.size(); ++i) {
        if (interrupted()) {
            fail({ErrorCode::io, "interrupted; nothing was written"});
            return kInterruptedStatus;
        }
        const auto format = render_pattern(*patterns, static_cast<int>(i), image, gamma);
        if (!format) {
            return fail(format.error());
        }
        const auto png = capture::encode_png(image.view(), *format);
        const auto ok =
            png ? folder->write(fmt::format("{:03}.png", i), *png) : Result<void>(png.error());
        if (!ok) {
            return fail(ok.error());
        }
    }
    if (gamma == GammaCompensation::precompensate) {
        // What is on the wall now is the sequence as written.
        patterns->response.reset();
        patterns->gamma = 1.0;
    }
    if (auto ok = folder->write(kPatternFile, capture::patterns_text(*patterns)); !ok) {
        return fail(ok.error());
    }
    if (auto ok = folder->commit(); !ok) {
        return fail(ok.error());
    }
    fmt::print("{} pictures of {}x{} pixels{}, and pattern.yaml, in {}\n",
               patterns->patterns.size(), patterns->projector_size.width,
               patterns->projector_size.height,
               gamma == GammaCompensation::precompensate ? ", compensated" : "", options.out);
    return 0;
}

}  // namespace

void add_calibrate(CLI::App& app, int& exit_status) {
    auto* command =
        app.add_subcommand("calibrate", "What is between projector and camera: their light");
    command->require_subcommand(1);

    auto* light = command->add_subcommand(
        "light", "The projector's response and the camera's colours, from a ramp and fringes");
    const auto light_options = std::make_shared<LightOptions>();
    light
        ->add_option("SOURCE", light_options->source,
                     "Folder of a recording of what `calibrate patterns` writes, on a plain wall; "
                     "or sim, sim:webcam-30")
        ->required();
    light
        ->add_option("--out", light_options->out,
                     "Where to put what was found: a folder whose rig.yaml and pattern.yaml are "
                     "updated, one of these files, or a new folder")
        ->check(not_empty());
    light->add_flag("--json", light_options->json, "The figures as one JSON object");
    light->callback([=, &exit_status] { exit_status = calibrate_light(*light_options); });

    auto* patterns = command->add_subcommand(
        "patterns", "Pictures that a projector is to show for `calibrate light`, and pattern.yaml");
    const auto pattern_options = std::make_shared<PatternOptions>();
    patterns->add_option("--out", pattern_options->out, "New folder for them")
        ->required()
        ->check(not_empty());
    auto* size = patterns->add_option("--size", pattern_options->size,
                                      "Of the projector, pixels, such as 1280x720");
    auto* axis =
        patterns
            ->add_option(
                "--axis", pattern_options->axis,
                "Axis along which fringes change: that of the way from camera to projector")
            ->check(CLI::IsMember({"x", "y"}))
            ->capture_default_str();
    auto* levels = patterns
                       ->add_option("--levels", pattern_options->levels,
                                    "Grey levels of the ramp; 16, 18 and 52 are shown exactly")
                       ->check(CLI::Range(9, 256))
                       ->capture_default_str();
    patterns
        ->add_option("--from", pattern_options->from,
                     "A pattern.yaml whose sequence is drawn instead, compensated by the response "
                     "or gamma in it")
        ->excludes(size)
        ->excludes(axis)
        ->excludes(levels);
    patterns->callback([=, &exit_status] { exit_status = write_patterns(*pattern_options); });
}

}  // namespace xtrack::tools
