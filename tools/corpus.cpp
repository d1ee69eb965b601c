// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <xtrack/joint_recording.hpp>
#include <xtrack/labels.hpp>

#include "core/sim/random.hpp"
#include "tools/commands.hpp"
#include "tools/corpus/images.hpp"
#include "tools/corpus/measure_noise.hpp"
#include "tools/corpus/performer.hpp"
#include "tools/corpus/report.hpp"
#include "tools/corpus/sequence.hpp"
#include "tools/progress.hpp"
#include "tools/settings_option.hpp"
#include "tools/stream.hpp"

namespace xtrack::tools {

namespace {

using corpus::Group;
using corpus::Part;
using corpus::Sequence;
using corpus::Tally;

struct CorpusOptions {
    double hours = 10.0;
    int people = 36;
    std::uint64_t seed = 1;
    double fps = 0.0;
    std::optional<std::string> gestures;
    std::vector<std::string> changes;
    bool images = false;
    std::string only;
    std::string save;
    bool explain = false;
    bool json = false;
    bool measure_noise = false;
};

constexpr int kTimes = 3;             // each gesture, by each person
constexpr double kSequenceS = 300.0;  // of everyday movement

/// A set of gestures with its thresholds.
struct Wanted {
    std::string name;
    GestureSettings settings;
    bool everyday = false;
    GestureSettings at_rest;  ///< those of it that movement without gestures is measured with
};

/// One sequence of one group, made and run when its turn comes.
struct Job {
    std::size_t group = 0;
    std::function<Result<Tally>()> work;
    std::function<Sequence()> make;  ///< none: images
};

Result<GestureSettings> settings_of(const CorpusOptions& options, const std::string& gestures) {
    GestureSettings settings;
    if (auto changed = apply_gesture_settings(options.changes, settings); !changed) {
        return changed.error();
    }
    if (auto chosen = choose_gestures(gestures, settings); !chosen) {
        return chosen.error();
    }
    settings.touch_plane_mm = corpus::touch_plane_mm();
    if (auto valid = validate(settings); !valid) {
        return valid.error();
    }
    return settings;
}

std::string without(const std::string& gestures, const std::string& left_out) {
    std::string kept;
    for (const std::string& one : CLI::detail::split(gestures, ',')) {
        if (one != left_out) {
            kept += (kept.empty() ? "" : ",") + one;
        }
    }
    return kept;
}

Result<std::vector<Wanted>> sets_of(const CorpusOptions& options) {
    std::vector<Wanted> all;
    const auto add = [&](const std::string& name, const std::string& list, bool everyday,
                         const std::string& not_everyday) -> Result<void> {
        auto settings = settings_of(options, list);
        if (!settings) {
            return settings.error();
        }
        auto at_rest = settings_of(options, without(list, not_everyday));
        if (!at_rest) {
            return at_rest.error();
        }
        all.push_back({name, *settings, everyday, *at_rest});
        return {};
    };
    if (options.gestures) {
        if (auto added = add(*options.gestures, *options.gestures, true, ""); !added) {
            return added.error();
        }
        return all;
    }
    for (const corpus::GestureSet& set : corpus::gesture_sets()) {
        if (auto added = add(set.name, set.gestures, set.everyday, set.not_everyday); !added) {
            return added.error();
        }
    }
    return all;
}

class Plan {
 public:
    Plan(const CorpusOptions& options, std::vector<Wanted> sets)
        : options_(options), sets_(std::move(sets)) {
        const auto wants = [&](Part part) {
            return options_.only.empty() || options_.only == to_string(part);
        };
        if (wants(Part::gestures)) {
            plan_gestures();
        }
        if (wants(Part::manners)) {
            plan_manners();
        }
        if (wants(Part::everyday)) {
            plan_everyday(Part::everyday);
        }
        if (wants(Part::engaged)) {
            plan_everyday(Part::engaged);
        }
        if (wants(Part::passers_by)) {
            plan_passers_by();
        }
        if (wants(Part::company)) {
            plan_company();
        }
        if (options.images || options.only == to_string(Part::images)) {
            plan_images();
        }
    }

    /// The first sequence of each group as a recording: joints.csv, labels.csv.
    Result<void> save(const std::filesystem::path& folder) const {
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            const auto job = std::find_if(jobs_.begin(), jobs_.end(), [g](const Job& j) {
                return j.group == g && j.make != nullptr;
            });
            if (job == jobs_.end()) {
                continue;
            }
            std::string name = fmt::format("{} {}", to_string(groups_[g].part), groups_[g].name);
            for (char& c : name) {
                c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '-';
            }
            std::error_code error;
            std::filesystem::create_directories(folder / name, error);
            if (error) {
                return Error{ErrorCode::io, (folder / name).string() + ": " + error.message() +
                                                "; choose a folder you may write to with --save"};
            }
            const Sequence sequence = job->make();
            if (auto written = write_joint_recording(folder / name / "joints.csv",
                                                     corpus::joints_of(sequence));
                !written) {
                return written.error();
            }
            if (auto written = write_labels(folder / name / "labels.csv", sequence.labels);
                !written) {
                return written.error();
            }
        }
        return {};
    }

    /// Sequences are independent, so every processor runs some; what they give is added in the
    /// order of the plan.
    Result<std::vector<Group>> run() {
        const std::size_t at_once = std::max(1U, std::thread::hardware_concurrency());
        std::deque<std::future<Result<Tally>>> running;
        std::size_t started = 0;
        Progress progress("corpus", jobs_.size());
        for (std::size_t done = 0; done < jobs_.size(); ++done) {
            while (started < jobs_.size() && running.size() < at_once) {
                running.push_back(std::async(std::launch::async, jobs_[started++].work));
            }
            const auto tally = running.front().get();
            running.pop_front();
            if (!tally) {
                return tally.error();
            }
            groups_[jobs_[done].group].tally.add(*tally);
            progress.step();
        }
        return std::move(groups_);
    }

 private:
    std::uint64_t seed(std::uint64_t number) const {
        return sim::mix(options_.seed, number) %
               1'000'000;  // short enough to read and to give again
    }
    std::size_t add_group(Part part, std::string name) {
        groups_.push_back({part, std::move(name), {}});
        return groups_.size() - 1;
    }
    void add_job(std::size_t group, const GestureSettings& settings,
                 const std::function<Sequence()>& make) {
        jobs_.push_back({group, [settings, make] { return corpus::run(make(), settings); }, make});
    }

    void plan_gestures() {
        for (const Wanted& set : sets_) {
            const auto names = corpus::names_of(set.settings);
            // A group for each way of seeing them, people in turn.
            std::array<std::size_t, corpus::kViewCount> groups{};
            for (std::size_t v = 0; v < corpus::kViewCount; ++v) {
                groups[v] = add_group(
                    Part::gestures,
                    fmt::format("{}; {}", set.name, to_string(static_cast<corpus::View>(v))));
            }
            for (int i = 0; i < options_.people; ++i) {
                const auto person = seed(static_cast<std::uint64_t>(i));
                const auto seen = corpus::seen_by(static_cast<std::uint64_t>(i), options_.fps);
                add_job(groups[static_cast<std::size_t>(seen.view)], set.settings, [=] {
                    return corpus::perform_all(names, corpus::draw_person(person), kTimes, seen);
                });
            }
        }
    }

    void plan_manners() {
        const Wanted& set = sets_.front();
        const auto names = corpus::names_of(set.settings);
        for (std::size_t m = 1; m < corpus::kMannerCount; ++m) {
            const auto manner = static_cast<corpus::Manner>(m);
            const std::size_t group =
                add_group(Part::manners, fmt::format("{}; {}", set.name, to_string(manner)));
            const int people = (options_.people + 2) / 3;
            for (int i = 0; i < people; ++i) {
                const auto person = seed(1000U * m + static_cast<std::uint64_t>(i));
                const auto seen = corpus::seen_by(static_cast<std::uint64_t>(i), options_.fps);
                add_job(group, set.settings, [=] {
                    return corpus::perform_all(names, corpus::draw_person(person, manner), kTimes,
                                               seen);
                });
            }
        }
    }

    [[nodiscard]] std::uint64_t pieces() const {
        return static_cast<std::uint64_t>(std::ceil(options_.hours * 3600.0 / kSequenceS));
    }

    /// @param part everyday, or engaged: it takes a session to be heard
    void plan_everyday(Part part) {
        for (const Wanted& set : sets_) {
            if (!set.everyday) {
                continue;
            }
            const std::size_t group = add_group(part, set.name);
            GestureSettings settings = set.at_rest;
            settings.engage = part == Part::engaged;
            for (std::uint64_t i = 0; i < pieces(); ++i) {
                add_job(group, settings,
                        [person = seed(100'000 + i), seen = corpus::seen_by(i, options_.fps)] {
                            return corpus::everyday(person, kSequenceS, seen);
                        });
            }
        }
    }

    void plan_passers_by() {
        GestureSettings settings = sets_.front().settings;
        settings.engage = true;
        const std::size_t group = add_group(Part::passers_by, sets_.front().name);
        for (std::uint64_t i = 0; i < pieces(); ++i) {
            add_job(group, settings,
                    [person = seed(200'000 + i), seen = corpus::seen_by(i, options_.fps)] {
                        return corpus::passers_by(person, kSequenceS, seen);
                    });
        }
    }

    void plan_company() {
        GestureSettings settings = sets_.front().settings;
        const auto names = corpus::names_of(settings);
        settings.engage = true;
        for (std::size_t c = 0; c < corpus::kCompanyCount; ++c) {
            const auto company = static_cast<corpus::Company>(c);
            const std::size_t group = add_group(Part::company, to_string(company));
            for (int i = 0; i < options_.people; ++i) {
                add_job(group, settings,
                        [=, person = seed(300'000 + 1000U * c + static_cast<std::uint64_t>(i)),
                         seen = corpus::seen_by(static_cast<std::uint64_t>(i), options_.fps)] {
                            return corpus::in_company(company, person, names, seen);
                        });
            }
        }
    }

    /// Images take a second for every second: fewer people, each gesture once.
    void plan_images() {
        const GestureSettings& settings = sets_.front().settings;
        const auto names = corpus::names_of(settings);
        for (const corpus::ImageRig& rig : corpus::kImageRigs) {
            const std::size_t group =
                add_group(Part::images, fmt::format("{}; {}", sets_.front().name, rig.name));
            const int people = (options_.people + 8) / 9;
            for (int i = 0; i < people; ++i) {
                const auto person = seed(400'000 + static_cast<std::uint64_t>(i));
                jobs_.push_back(
                    {group,
                     [=] {
                         return corpus::run_images(
                             corpus::perform_all(
                                 names, corpus::before_a_rig(corpus::draw_person(person)), 1, {}),
                             rig, settings);
                     },
                     {}});
            }
        }
    }

    const CorpusOptions& options_;
    std::vector<Wanted> sets_;
    std::vector<Group> groups_;
    std::vector<Job> jobs_;
};

int make_corpus(const CorpusOptions& options) {
    auto sets = sets_of(options);
    if (!sets) {
        return usage(sets.error());
    }
    Plan plan(options, std::move(*sets));
    if (!options.save.empty()) {
        if (auto saved = plan.save(options.save); !saved) {
            return fail(saved.error());
        }
    }
    auto groups = plan.run();
    if (!groups) {
        return fail(groups.error());
    }
    fmt::print("{}", options.json ? corpus::json_of(*groups).dump(2) + "\n"
                                  : corpus::text_of(*groups, options.explain));
    return 0;
}

}  // namespace

void add_corpus(CLI::App& app, int& exit_status) {
    auto* command = app.add_subcommand(
        "corpus", "Simulated people gesture, and do what is no gesture: rates with 95 % intervals");
    const auto options = std::make_shared<CorpusOptions>();
    command->add_option("--hours", options->hours, "Of movement that is no gesture")
        ->check(CLI::Range(0.01, 1000.0))
        ->capture_default_str();
    command->add_option("--people", options->people, "Who gesture, for each set of gestures")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
    command->add_option("--seed", options->seed, "Other people for every number")
        ->check(CLI::Range(0U, 1'000'000'000U))
        ->capture_default_str();
    command->add_option("--fps", options->fps, "Of every sequence (else 20, 30, 60 and 120)")
        ->check(CLI::Range(5.0, 240.0));
    command->add_option(
        "--gestures", options->gestures,
        "One set of gestures, comma-separated (else the whole vocabulary, in sets)");
    add_gesture_settings_option(*command, options->changes);
    command->add_flag("--images", options->images,
                      "Fringe images through the whole pipeline, too (some minutes)");
    command->add_option("--only", options->only, "One part alone")
        ->check(CLI::IsMember(std::vector<std::string>{"gestures", "manners", "everyday", "engaged",
                                                       "passers-by", "company", "images"}));
    command
        ->add_option("--save", options->save,
                     "Folder for the first sequence of each kind, as a recording of joints")
        ->check(not_empty());
    command->add_flag("--explain", options->explain, "Every false event and missed gesture");
    command->add_flag("--json", options->json, "JSON instead of tables");
    command->add_flag("--measure-noise", options->measure_noise,
                      "Print what the simulated rigs' trackers are off by, for --people of each");
    command->callback([=, &exit_status] {
        if (!options->measure_noise) {
            exit_status = make_corpus(*options);
            return;
        }
        const auto text = corpus::measure_noise(options->people);
        if (!text) {
            exit_status = fail(text.error());
            return;
        }
        fmt::print("{}", *text);
    });
}

}  // namespace xtrack::tools
