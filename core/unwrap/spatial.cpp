// SPDX-License-Identifier: Apache-2.0
#include "core/unwrap/spatial.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/base/setting_up.hpp"
#include "core/base/text.hpp"
#include "core/unwrap/run_graph.hpp"
#include "core/unwrap/spatial_row.hpp"
#include "core/unwrap/step_maps.hpp"

namespace xtrack {
namespace {

constexpr float kTurn_rad = 2.0F * std::numbers::pi_v<float>;
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr double kLeastLimit_rad = 0.1;
constexpr double kMostLimit_rad = 3.1;

Error out_of_range(const char* name, double value, const std::string& range) {
    return {ErrorCode::invalid_argument,
            std::string(name) + " = " + base::number_text(value) + ": it must be " + range};
}

}  // namespace

class SpatialUnwrapper::Impl {
 public:
    Impl(Size size, const SpatialUnwrapSettings& settings)
        : size_(size), settings_(settings), maps_(size), graph_(size) {
        const auto pixels =
            static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
        const auto row = static_cast<std::size_t>(maps_.words()) * kWordPixels;
        order_.reserve(pixels);
        label_.reserve(pixels);
        roots_.reserve(pixels);
        components_.reserve(std::min<std::size_t>(pixels, kMaxPhaseComponents));
        seeds_.reserve(components_.capacity());
        // A pixel with a phase, and nothing after it.
        pieces_.reserve(2 * row + 1);
        phase_row_.resize(row);
    }

    std::span<const PhaseComponent> unwrap(ImageView<const float> phase_rad,
                                           ImageView<const float> modulation,
                                           ImageView<float> unwrapped_rad,
                                           ImageView<std::uint16_t> component) {
        if (phase_rad.size() != size_ || modulation.size() != size_ ||
            unwrapped_rad.size() != size_ || component.size() != size_) {
            return {};
        }
        const auto found = solve(phase_rad, modulation);
        for (int y = 0; y < size_.height; ++y) {
            write_row(y, phase_rad.row(y), {}, unwrapped_rad.row(y), component.row(y));
        }
        return found;
    }

    std::span<const PhaseComponent> solve(ImageView<const float> phase_rad,
                                          ImageView<const float> modulation) {
        if (phase_rad.size() != size_ || modulation.size() != size_) {
            return {};
        }
        maps_.make(phase_rad, modulation, static_cast<float>(settings_.step_limit_rad));
        graph_.build(maps_, settings_.min_support);
        label_runs();
        measure(modulation);
        return components_;
    }

    [[nodiscard]] PhasePlace place(int x, int y) const noexcept;
    void write_row(int y, const float* phase_rad, std::span<const std::int32_t> turns,
                   float* unwrapped_rad, std::uint16_t* component) noexcept;
    void set_settings(const SpatialUnwrapSettings& settings) noexcept { settings_ = settings; }

 private:
    /// Of each component: what its seed is known by.
    struct Seed {
        float modulation = -1.0F;
        std::int32_t order = 0;
    };

    void label_runs();
    void measure(ImageView<const float> modulation);
    void take_seed(std::uint32_t run, int word, int y, const float* modulation);

    Size size_;
    SpatialUnwrapSettings settings_;
    StepMaps maps_;
    RunGraph graph_;
    std::vector<std::uint32_t> roots_;
    std::vector<std::int32_t> order_;   ///< of each run's first pixel
    std::vector<std::uint16_t> label_;  ///< of each run: its component's id, or 0
    std::vector<PhaseComponent> components_;
    std::vector<Seed> seeds_;
    std::vector<PhasePiece> pieces_;  ///< of a row
    std::vector<float> phase_row_;    ///< a copy of one that is to be overwritten
};

/// Numbers the regions that are large enough, and gives every run its region's number.
void SpatialUnwrapper::Impl::label_runs() {
    OrderForest& forest = graph_.forest();
    roots_.clear();
    order_.resize(graph_.size());
    label_.resize(graph_.size());
    for (std::uint32_t run = 0; run < graph_.size(); ++run) {
        label_[run] = 0;
        if (forest.find(run).root == run &&
            forest.pixels(run) >= static_cast<std::uint32_t>(settings_.min_component_px)) {
            roots_.push_back(run);
        }
    }
    std::sort(roots_.begin(), roots_.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::pair(forest.pixels(b), a) < std::pair(forest.pixels(a), b);
    });
    roots_.resize(std::min<std::size_t>(roots_.size(), kMaxPhaseComponents));
    components_.clear();
    seeds_.assign(roots_.size(), Seed{});
    for (const std::uint32_t root : roots_) {
        PhaseComponent component;
        component.id = static_cast<std::uint16_t>(components_.size() + 1);
        component.pixels = static_cast<int>(forest.pixels(root));
        component.left_px = size_.width;
        component.top_px = size_.height;
        components_.push_back(component);
        label_[root] = component.id;
    }
    for (std::uint32_t run = 0; run < graph_.size(); ++run) {
        const OrderForest::Place place = forest.find(run);
        order_[run] = place.order;
        label_[run] = label_[place.root];
    }
}

/// Bounding boxes and seeds.
void SpatialUnwrapper::Impl::measure(ImageView<const float> modulation) {
    for (int y = 0; y < size_.height; ++y) {
        for (int word = 0; word < maps_.words(); ++word) {
            const RunGraph::Range range = graph_.runs_of(word, y);
            const float best = maps_.best_modulation[maps_.at(word, y)];
            for (std::uint32_t run = range.begin; run < range.end; ++run) {
                if (label_[run] == 0) {
                    continue;
                }
                PhaseComponent& component = components_[label_[run] - 1U];
                component.left_px =
                    std::min(component.left_px, word * kWordPixels + graph_.run(run).first);
                component.right_px =
                    std::max(component.right_px, word * kWordPixels + graph_.run(run).last);
                component.top_px = std::min(component.top_px, y);
                component.bottom_px = y;
                // Few words hold a new best; only those are looked through.
                if (best > seeds_[label_[run] - 1U].modulation) {
                    take_seed(run, word, y, modulation.row(y));
                }
            }
        }
    }
}

/// Makes the best pixel of a run its component's seed, if it is better than what there is.
void SpatialUnwrapper::Impl::take_seed(std::uint32_t index, int word, int y,
                                       const float* modulation) {
    const Run run = graph_.run(index);
    Seed& seed = seeds_[label_[index] - 1U];
    PhaseComponent& component = components_[label_[index] - 1U];
    int found = -1;
    for (int bit = run.first; bit <= run.last; ++bit) {
        const float value = known_modulation(modulation[word * kWordPixels + bit]);
        if (value > seed.modulation) {
            seed.modulation = value;
            found = bit;
        }
    }
    if (found >= 0) {
        const std::size_t at = maps_.at(word, y);
        component.seed_x_px = word * kWordPixels + found;
        component.seed_y_px = y;
        seed.order = order_[index] + maps_.rise_along(at, run.mask() & bits_below(found));
    }
}

PhasePlace SpatialUnwrapper::Impl::place(int x, int y) const noexcept {
    const int word = x / kWordPixels;
    const int bit = x % kWordPixels;
    const RunGraph::Range range = graph_.runs_of(word, y);
    for (std::uint32_t index = range.begin; index < range.end; ++index) {
        const Run run = graph_.run(index);
        if (run.last < bit) {
            continue;
        }
        const std::uint16_t id = label_[index];
        if (run.first > bit || id == 0) {
            break;
        }
        return {id, order_[index] - seeds_[id - 1U].order +
                        maps_.rise_along(maps_.at(word, y), run.mask() & bits_below(bit))};
    }
    return {};
}

void SpatialUnwrapper::Impl::write_row(int y, const float* phase_rad,
                                       std::span<const std::int32_t> turns, float* unwrapped_rad,
                                       std::uint16_t* component) noexcept {
    pieces_.clear();
    // Pieces of no pixels are left out.
    const auto put = [this](int end, float add_rad, std::uint16_t id) {
        if (end > (pieces_.empty() ? 0 : pieces_.back().end)) {
            pieces_.push_back({end, add_rad, id});
        }
    };
    for (int word = 0; word < maps_.words(); ++word) {
        const std::size_t at = maps_.at(word, y);
        const int x = word * kWordPixels;
        const RunGraph::Range range = graph_.runs_of(word, y);
        for (std::uint32_t index = range.begin; index < range.end; ++index) {
            const std::uint16_t id = label_[index];
            if (id == 0) {
                continue;
            }
            const Run run = graph_.run(index);
            put(x + run.first, kNone, 0);
            std::int32_t order =
                order_[index] - seeds_[id - 1U].order + (id <= turns.size() ? turns[id - 1U] : 0);
            StepMaps::Word wraps =
                (maps_.right_up[at] | maps_.right_down[at]) & run.mask() & bits_below(run.last);
            for (; wraps != 0; wraps &= wraps - 1) {
                put(x + std::countr_zero(wraps) + 1, kTurn_rad * static_cast<float>(order), id);
                order += (maps_.right_up[at] & wraps & (~wraps + 1)) != 0 ? 1 : -1;
            }
            put(x + run.last + 1, kTurn_rad * static_cast<float>(order), id);
        }
    }
    put(size_.width, kNone, 0);
    if (phase_rad == unwrapped_rad) {
        std::copy_n(phase_rad, size_.width, phase_row_.data());
        phase_rad = phase_row_.data();
    }
    piece_row({size_.width, pieces_, phase_rad, unwrapped_rad, component});
}

Result<void> validate(const SpatialUnwrapSettings& settings) {
    const double limit = settings.step_limit_rad;
    if (!(limit >= kLeastLimit_rad && limit <= kMostLimit_rad)) {
        return out_of_range("step_limit_rad", limit, "0.1 ... 3.1, less than half a turn");
    }
    if (!(settings.min_support >= 0.0 && settings.min_support <= 1.0)) {
        return out_of_range("min_support", settings.min_support, "0 ... 1");
    }
    if (settings.min_component_px < 1 || settings.min_component_px > kMaxImagePixels) {
        return out_of_range("min_component_px", settings.min_component_px,
                            "1 ... " + std::to_string(kMaxImagePixels));
    }
    return {};
}

Result<SpatialUnwrapper> SpatialUnwrapper::create(Size size,
                                                  const SpatialUnwrapSettings& settings) {
    return base::setting_up("spatial unwrapper", [&]() -> Result<SpatialUnwrapper> {
        if (!is_image_size(size)) {
            return Error{ErrorCode::invalid_argument, "spatial unwrapper: an image cannot be " +
                                                          std::to_string(size.width) + " x " +
                                                          std::to_string(size.height) + " pixels"};
        }
        if (auto valid = validate(settings); !valid) {
            return Error{valid.error().code, "spatial unwrapper: " + valid.error().message};
        }
        return SpatialUnwrapper(std::make_unique<Impl>(size, settings));
    });
}

SpatialUnwrapper::SpatialUnwrapper(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
SpatialUnwrapper::SpatialUnwrapper(SpatialUnwrapper&&) noexcept = default;
SpatialUnwrapper& SpatialUnwrapper::operator=(SpatialUnwrapper&&) noexcept = default;
SpatialUnwrapper::~SpatialUnwrapper() = default;

std::span<const PhaseComponent> SpatialUnwrapper::unwrap(ImageView<const float> phase_rad,
                                                         ImageView<const float> modulation,
                                                         ImageView<float> unwrapped_rad,
                                                         ImageView<std::uint16_t> component) {
    return impl_->unwrap(phase_rad, modulation, unwrapped_rad, component);
}

std::span<const PhaseComponent> SpatialUnwrapper::solve(ImageView<const float> phase_rad,
                                                        ImageView<const float> modulation) {
    return impl_->solve(phase_rad, modulation);
}

PhasePlace SpatialUnwrapper::place(int x, int y) const noexcept { return impl_->place(x, y); }

void SpatialUnwrapper::write_row(int y, const float* phase_rad, std::span<const std::int32_t> turns,
                                 float* unwrapped_rad, std::uint16_t* component) noexcept {
    impl_->write_row(y, phase_rad, turns, unwrapped_rad, component);
}

Result<void> SpatialUnwrapper::set_settings(const SpatialUnwrapSettings& settings) {
    if (auto valid = validate(settings); !valid) {
        return valid;
    }
    impl_->set_settings(settings);
    return {};
}

}  // namespace xtrack
