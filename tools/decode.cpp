// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <xtrack/depth_decoder.hpp>
#include <xtrack/phase_ripple.hpp>
#include <xtrack/recording.hpp>
#include <xtrack/relative_depth.hpp>

#include "core/base/file.hpp"
#include "core/capture/image_codec.hpp"
#include "core/capture/in_recording.hpp"
#include "tools/commands.hpp"
#include "tools/decode_choice.hpp"
#include "tools/decode_exports.hpp"
#include "tools/decode_gamma.hpp"
#include "tools/decode_pictures.hpp"
#include "tools/decode_report.hpp"
#include "tools/interrupt.hpp"
#include "tools/order_depth.hpp"
#include "tools/progress.hpp"
#include "tools/settings_option.hpp"
#include "tools/stream.hpp"

namespace xtrack::tools {

namespace {

namespace fs = std::filesystem;

// Projectors have 1.8 to 2.4, and 1 where that is corrected: less was corrected twice.
constexpr double kUsualGamma = 0.9;

// Of one of the three names that the option takes.
Export export_of(const std::string& name) {
    if (name == "pcd") {
        return Export::pcd;
    }
    return name == "obj" ? Export::obj : Export::ply;
}

// Makes the folder of the answer, with its parents. What is there already is never touched.
Result<base::NewFolder> make_output(const fs::path& wanted) {
    const fs::path out = wanted.has_filename() ? wanted : wanted.parent_path();
    std::error_code error;
    if (out.has_parent_path()) {
        fs::create_directories(out.parent_path(), error);
    }
    return base::NewFolder::create(out);
}

int steps_of(const std::vector<double>& phases) { return static_cast<int>(phases.size()); }

// Folders of frames are named as their files where these names tell them apart and name a folder:
// what is left of "...png" without its extension is the parent.
bool stems_name_folders(const RecordingReader& recording) {
    const auto entries = recording.entries();
    return !stems_repeat(recording) &&
           std::all_of(entries.begin(), entries.end(), [](const RecordingEntry& entry) {
               const std::string stem = fs::path(entry.file).stem().string();
               return stem != "." && base::stays_inside(stem);
           });
}

class DecodeRun {
 public:
    DecodeRun(const DecodeOptions& options, RecordingReader recording, PatternSequence patterns,
              ChosenDecoder chosen, OrderDepth order)
        : options_(options),
          recording_(std::move(recording)),
          patterns_(std::move(patterns)),
          chosen_(std::move(chosen)),
          order_(std::move(order)),
          numbered_(!stems_name_folders(recording_)) {}

    Result<void> run() {
        auto source = frame_source(recording_);
        if (!source) {
            return source.error();
        }
        Progress progress("decode", recording_.entries().size());
        const std::size_t frames = recording_.entries().size();
        for (std::size_t i = 0; i < frames && (options_.all || reports_.empty()); ++i) {
            if (interrupted()) {
                return interrupted_error();
            }
            const FrameSource::Item item = (*source)->next(Duration::zero());
            if (item.status != SourceStatus::ok) {
                return Error{ErrorCode::malformed, item.message};
            }
            if (auto ok = give_order(i); !ok) {
                return ok;
            }
            if (chosen_.decoder.push(item.frame).state == DecodeState::depth_ready) {
                if (auto ok = write_set(i); !ok) {
                    return ok;
                }
            }
            progress.step();
        }
        if (interrupted()) {
            return interrupted_error();
        }
        if (reports_.empty()) {
            return no_complete_set(recording_);
        }
        if (std::all_of(reports_.begin(), reports_.end(),
                        [](const DecodeReport& r) { return r.valid_percent <= 0.0; })) {
            return Error{
                ErrorCode::malformed,
                fmt::format("{}: no pixel has {}; is pattern.yaml that of these images, "
                            "the rig that of this camera, min_modulation of {:g} grey "
                            "levels too much?",
                            recording_.folder().string(), chosen_.makes_depth ? "depth" : "a phase",
                            chosen_.decoder.settings().min_modulation)};
        }
        return output_->commit();
    }

    [[nodiscard]] std::string answer() const {
        std::string method = describe(patterns_) + "; " + chosen_.order;
        if (std::any_of(reports_.begin(), reports_.end(),
                        [](const auto& r) { return r.relative; })) {
            method += ", unwrapped in space; heights without scale";
        }
        if (options_.gamma) {
            const bool found = options_.gamma == "auto";
            method += fmt::format("; gamma {:.2f}{}", *patterns_.gamma,
                                  !found ? ""
                                  : *patterns_.gamma < kUsualGamma
                                      ? " from the fringes, less than projectors have: were the "
                                        "patterns bent before they were shown, or the camera's "
                                        "images after?"
                                      : " from the fringes");
        } else if (patterns_.response) {
            method += "; the measured response of pattern.yaml";
        }
        std::string note = chosen_.note;
        if (!chosen_.makes_depth && std::any_of(reports_.begin(), reports_.end(),
                                                [](const auto& r) { return !r.relative; })) {
            note += "; where no surface is large enough for heights there are no points either";
        }
        return options_.json ? json_of(method, note, reports_) : table_of(method, note, reports_);
    }

 private:
    static Error interrupted_error() { return {ErrorCode::io, "interrupted; nothing was written"}; }

    // The depth that gives the order is that of the frame which the result will belong to: the
    // newest one where motion is followed, else the centre of the window.
    Result<void> give_order(std::size_t newest) {
        if (!order_.wanted()) {
            return {};
        }
        const auto window = static_cast<std::size_t>(std::max(1, chosen_.decoder.frames_needed()));
        const std::size_t back = options_.all ? 0 : (window - 1) / 2;
        const std::size_t frame = newest - std::min(newest, back);
        const auto depth = order_.of(recording_, frame);
        if (!depth) {
            return depth.error();
        }
        return chosen_.decoder.set_order_depth((*depth)->view(), kDepthUnitMm);
    }

    Result<void> write_set(std::size_t newest) {
        const DepthFrame& depth = chosen_.decoder.depth();
        const auto entries = recording_.entries();
        // Backwards and by both: neither stamps nor sequences need to be different everywhere.
        std::size_t index = newest;
        while (index > 0 &&
               (entries[index].sequence != depth.sequence || entries[index].stamp != depth.stamp)) {
            --index;
        }
        if (!output_) {
            auto output = make_output(options_.out);
            if (!output) {
                return output.error();
            }
            output_.emplace(std::move(*output));
        }
        fs::path inside;
        if (options_.all) {
            inside = numbered_ ? fs::path(fmt::format("{:06}", index))
                               : fs::path(entries[index].file).stem();
            if (auto ok = output_->make_folder(inside); !ok) {
                return ok;
            }
        }
        DecodeReport report;
        report.frame = entries[index].file;
        report.folder = inside.string();
        report.stamp = entries[index].stamp;
        if (auto ok = write_phase(inside, report); !ok) {
            return ok;
        }
        if (chosen_.makes_depth) {
            if (auto ok = write_depth(inside, index, report); !ok) {
                return ok;
            }
        }
        reports_.push_back(std::move(report));
        return {};
    }

    Result<void> write(const fs::path& file, const Result<std::string>& bytes) {
        return bytes ? output_->write(file, *bytes) : Result<void>(bytes.error());
    }

    Result<void> write_phase(const fs::path& inside, DecodeReport& report) {
        const PhaseMap& map = chosen_.decoder.phase();
        if (auto ok = write(inside / "modulation.png", grey_png(map.modulation.view())); !ok) {
            return ok;
        }
        if (map.phase_rad.empty()) {  // a Gray code without sines
            return {};
        }
        Image<float> wrapped = map.phase_rad;
        std::size_t known = 0;
        for (int y = 0; y < wrapped.height(); ++y) {
            for (int x = 0; x < wrapped.width(); ++x) {
                if (map.modulation.at(x, y) > 0.0F) {
                    ++known;
                } else {
                    wrapped.at(x, y) = std::numeric_limits<float>::quiet_NaN();
                }
            }
        }
        report.valid_percent = 100.0 * static_cast<double>(known) /
                               (static_cast<double>(wrapped.width()) * wrapped.height());
        if (auto ok = write(inside / "wrapped.tiff", capture::encode_tiff(wrapped.view())); !ok) {
            return ok;
        }
        if (const auto ripple = measure_ripple(map, steps_of(shortest_phases(patterns_)))) {
            report.ripple = *ripple;
        }
        if (chosen_.makes_depth) {
            return {};
        }
        auto relative = measure_relative(map);
        if (!relative) {
            return relative.error();
        }
        if (*relative) {
            report.relative = true;
            return write_relative(inside, report);
        }
        return write(inside / "preview.png",
                     phase_preview(wrapped.view(), fmt::format("{}  wrapped phase, {:g} px",
                                                               report.frame, map.period_px)));
    }

    // False where the phase holds no surface to measure from.
    Result<bool> measure_relative(const PhaseMap& map) {
        if (!relative_) {
            auto made = RelativeDepth::create(map.phase_rad.size());
            if (!made) {
                return made.error();
            }
            relative_.emplace(std::move(*made));
        }
        const auto measured = relative_->measure(map);
        if (!measured && measured.error().code != ErrorCode::unsupported) {
            return measured.error();
        }
        return measured.ok();
    }

    Result<void> write_relative(const fs::path& inside, const DecodeReport& report) {
        if (auto ok = write(inside / "unwrapped.tiff",
                            capture::encode_tiff(relative_->unwrapped_rad().view()));
            !ok) {
            return ok;
        }
        const ImageView<const float> height = relative_->height_rad().view();
        if (auto ok = write(inside / "height.tiff", capture::encode_tiff(height)); !ok) {
            return ok;
        }
        Rig rig;
        rig.camera = recording_.has_rig() ? recording_.rig().camera
                                          : nominal_camera(recording_.image_size());
        if (auto ok = write_exports(options_.exports, relative_->depth(), rig,
                                    chosen_.decoder.average().view(), output_->path() / inside);
            !ok) {
            return ok;
        }
        return write(inside / "preview.png",
                     height_preview(height, fmt::format("{}  height above the background, no scale",
                                                        report.frame)));
    }

    Result<void> write_depth(const fs::path& inside, std::size_t index, DecodeReport& report) {
        const DepthFrame& depth = chosen_.decoder.depth();
        measure_depth(depth, report);
        auto truth = measure_truth(recording_, index, depth);
        if (!truth) {
            return truth.error();
        }
        report.truth = *truth;
        if (auto ok = write(inside / "coordinate.tiff",
                            capture::encode_tiff(chosen_.decoder.coordinate_px().view()));
            !ok) {
            return ok;
        }
        if (auto ok = write(inside / "depth.png", capture::encode_png(depth.depth.view())); !ok) {
            return ok;
        }
        if (auto ok = write_exports(options_.exports, depth, recording_.rig(),
                                    chosen_.decoder.average().view(), output_->path() / inside);
            !ok) {
            return ok.error().code == ErrorCode::invalid_argument
                       ? capture::in_recording(recording_.folder(), ok.error())
                       : ok;
        }
        return write(
            inside / "preview.png",
            depth_preview(depth.depth.view(), depth.depth_unit_mm, report.low_mm, report.high_mm,
                          fmt::format("{}  median {:.1f} mm, {:.0f} % of pixels", report.frame,
                                      report.median_mm, report.valid_percent)));
    }

    DecodeOptions options_;
    RecordingReader recording_;
    PatternSequence patterns_;  // with the gamma that is corrected
    ChosenDecoder chosen_;
    OrderDepth order_;
    bool numbered_;  // folders of frames are named by number: their files' names do not tell them
    std::optional<base::NewFolder> output_;
    std::optional<RelativeDepth> relative_;  // where there is no other
    std::vector<DecodeReport> reports_;
};

int decode(const DecodeOptions& options) {
    const NoteInterrupt note;
    const auto recording = RecordingReader::open(options.recording);
    if (!recording) {
        return fail(recording.error());
    }
    if (recording->kind() != RecordingKind::fringe) {
        return fail({ErrorCode::unsupported,
                     options.recording + ": pattern.yaml is missing; decode needs fringes, replay "
                                         "takes depth and joints"});
    }
    auto order = OrderDepth::open(*recording, options.order_from);
    if (!order) {
        return fail(order.error());
    }
    auto patterns = with_gamma(*recording, options.gamma);
    if (!patterns) {
        return fail(patterns.error());
    }
    auto chosen = choose_decoder(*recording, *patterns, options);
    if (!chosen) {
        return fail(chosen.error());
    }
    DecodeRun run(options, *recording, *patterns, std::move(*chosen), std::move(*order));
    if (auto ok = run.run(); !ok) {
        const int status = fail(ok.error());
        return interrupted() ? kInterruptedStatus : status;
    }
    std::fputs(run.answer().c_str(), stdout);
    return 0;
}

}  // namespace

void add_decode(CLI::App& app, int& exit_status) {
    auto* command = app.add_subcommand(
        "decode", "Phase, depth, point cloud and a picture of the first complete set of patterns");
    const auto options = std::make_shared<DecodeOptions>();
    command->add_option("REC", options->recording, "Folder of a fringe recording")->required();
    command->add_option("--out", options->out, "Folder for the results; made whole or not at all")
        ->required();
    command->add_flag(
        "--all", options->all,
        "Every depth image, each in a folder named as its frame (numbered where the names "
        "do not tell frames apart)");
    command
        ->add_option("--order-from", options->order_from,
                     "Fringe order from a 16-bit depth image of 0.1 mm a step, or a folder of "
                     "them named as the frames; such as truth/depth, also inside REC")
        ->check(not_empty());
    command
        ->add_option("--min-modulation", options->min_modulation,
                     "Fringe amplitude below which a pixel is masked, grey levels")
        ->capture_default_str()
        ->check(not_empty());
    add_settings_option(*command, options->changes, DepthDecoder::uses);
    command->add_option(
        "--gamma", options->gamma,
        "The projector's response, light = value^gamma: a number, or auto to find it "
        "from the fringes (default: as pattern.yaml says)");
    command
        ->add_option_function<std::vector<std::string>>(
            "--export",
            [options](const std::vector<std::string>& names) {
                options->exports.clear();
                for (const std::string& name : names) {
                    options->exports.insert(export_of(name));
                }
            },
            "Forms of the points: ply (cloud.ply), pcd (cloud.pcd), obj (mesh.obj with mesh.mtl "
            "and mesh.png); a list such as ply,obj")
        ->delimiter(',')
        ->check(CLI::IsMember({"ply", "pcd", "obj"}))
        ->default_str("ply");
    command->add_flag("--json", options->json, "The figures as one JSON object");
    command->callback([command, options, &exit_status] {
        DecodeSettings settings;
        settings.min_modulation = options->min_modulation;
        const bool twice =
            command->count("--min-modulation") > 0 &&
            std::any_of(options->changes.begin(), options->changes.end(),
                        [](const std::string& c) { return c.starts_with("min_modulation="); });
        if (twice) {
            exit_status =
                usage({ErrorCode::invalid_argument,
                       "--min-modulation and --set min_modulation are the same; give one"});
            return;
        }
        for (const auto& ok : {validate(settings), apply_settings(options->changes, settings)}) {
            if (!ok) {
                exit_status = usage(ok.error());
                return;
            }
        }
        if (const auto ok =
                check_settings(options->changes, DecodeMethod::pattern, DepthDecoder::uses);
            !ok) {
            exit_status = usage({ok.error().code, "--set " + ok.error().message});
            return;
        }
        if (const std::string why = gamma_complaint(options->gamma); !why.empty()) {
            exit_status = usage({ErrorCode::invalid_argument, why});
            return;
        }
        exit_status = decode(*options);
    });
}

}  // namespace xtrack::tools
