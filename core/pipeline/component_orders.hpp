// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <xtrack/image.hpp>
#include <xtrack/pattern.hpp>

#include "core/depth/triangulation.hpp"
#include "core/unwrap/spatial.hpp"

namespace xtrack {

/// Whole fringes for surfaces that nothing in the picture connects: PaperDecoder says by what
/// rules. Every rule is put to the vote of pixels on a grid, as single ones are noise.
///
/// "Value" is a pixel's phase with its turns within the component, in turns; "order" what is added
/// to the values of a whole component.
class ComponentOrders {
 public:
    /// Components after this many, the smallest, are put where their seeds say.
    static constexpr std::size_t kMostComponents = 256;
    /// In component_before: what stood still.
    static constexpr std::uint16_t kStill = kMaxPhaseComponents + 1;

    /// Allocates for all images to come.
    /// @param geometry null: values are heights above a background at 0
    /// @param period_px, coded_length_px of the pattern
    /// @param most_height_px of heights: none is farther from 0
    /// @param axis along which shadows fall in the image, as far as camera and projector agree
    ComponentOrders(Size image, Axis axis, const Triangulation* geometry, double period_px,
                    int coded_length_px, double most_height_px);

    struct Input {
        const SpatialUnwrapper& unwrapper;
        std::span<const PhaseComponent> components;
        ImageView<const float> phase_rad;  ///< that was solved
        /// What was taken off it before, with all turns; empty: nothing.
        ImageView<const float> reference_rad;
        /// The image before with its orders, NaN = none; and its components.
        ImageView<const float> before_rad;
        ImageView<const std::uint16_t> component_before;
        /// Of heights: 1 where more phase is nearer, -1 where less is, 0 where that is not known.
        double front = 0.0;
        /// Pixels that stand still, with all turns, NaN elsewhere: no component is there. Empty:
        /// nothing is known of what stands still.
        ImageView<const float> still_rad = {};
        ImageView<const float> known_rad = {};  ///< StillScene::known_rad()
        ImageView<const float> modulation = {};
        ImageView<const float> all_rad = {};  ///< phase_rad, and all that was taken out of it
        int still_pixels = 0;
    };
    /// Replaces the orders of the image before.
    void choose(const Input& input) noexcept;
    void forget() noexcept;

    /// By component - 1; valid until the next call of choose() or forget().
    [[nodiscard]] std::span<const std::int32_t> orders() const noexcept { return orders_; }
    [[nodiscard]] bool ambiguous(std::size_t index) const noexcept {
        return ambiguous_[index] != 0;
    }
    /// Of depths: farther away is less phase.
    [[nodiscard]] bool far_is_low() const noexcept { return far_is_low_; }
    /// How far and on how many places pixels stand out from 0, turns; negative: behind it.
    [[nodiscard]] double standing_out() const noexcept { return standing_out_; }
    /// Of heights: on how many lines a shadow says that more phase is nearer, less those on which
    /// one says that less is.
    [[nodiscard]] int shadows() const noexcept { return shadows_; }

 private:
    static constexpr float kPerTurn = 0.15915494F;     ///< turns of a radian
    static constexpr int kGrid_px = 4;                 ///< on which pixels are asked
    static constexpr std::size_t kMostBridges = 8192;  ///< of an image; more are not looked at
    /// Of what a shadow may be measured: scraps at the edges of things that move are no surface.
    static constexpr int kBridgeablePixels = 1500;

    /// Votes for orders, kept clean between uses.
    class Votes {
     public:
        void create(int reach) {
            reach_ = reach;
            counts_.assign(2 * static_cast<std::size_t>(reach) + 2, 0);
        }
        void add(int order, int count = 1) noexcept;
        void clear() noexcept;
        [[nodiscard]] int of(int order) const noexcept;
        [[nodiscard]] int low() const noexcept { return low_; }
        [[nodiscard]] int high() const noexcept { return high_; }
        [[nodiscard]] int total() const noexcept { return total_; }
        /// Of the most votes, the least such; 0 where there are none.
        [[nodiscard]] int best() const noexcept;
        /// The least order up to which so much of the votes are; `share` 0 ... 1.
        [[nodiscard]] int reached(double share) const noexcept;

     private:
        std::vector<std::int32_t> counts_;
        int reach_ = 0;
        int low_ = 0;  ///< low_ > high_: none
        int high_ = -1;
        int total_ = 0;
    };
    /// Two components on either side of a shadow; or where one touches what stands still.
    struct Bridge {
        std::uint16_t from = 0;
        std::uint16_t to = 0;
        std::int32_t orders = 0;  ///< of `to` less that of `from`
        bool fits = false;        ///< the fringe goes on; where they touch, the light as well
        bool touch = false;
        bool joint = false;  ///< no shadow: a cut of a few pixels between two that move
        float rise = 0.0F;   ///< of what was taken off, from one side to the other, turns
    };
    /// What there is on a line of pixels.
    struct Line {
        const float* phase_rad = nullptr;  ///< shadows have none
        const float* still_rad = nullptr;
        const float* modulation = nullptr;
        std::ptrdiff_t next = 0;  ///< from a pixel to the next, of each
        std::ptrdiff_t next_still = 0;
        std::ptrdiff_t next_modulation = 0;
        int number = 0;
        int length = 0;
        bool along_x = true;
        [[nodiscard]] int x(int i) const noexcept { return along_x ? i : number; }
        [[nodiscard]] int y(int i) const noexcept { return along_x ? number : i; }
        [[nodiscard]] bool stands(int i) const noexcept;
        [[nodiscard]] bool seen(int i) const noexcept;
    };
    [[nodiscard]] Line line_of(const Input& input, int number, bool along_x) const noexcept;
    /// The value at a border, going by what lies `away` (1 or -1) from it.
    [[nodiscard]] float edge(const Input& input, const Line& line, int border, int away,
                             std::uint16_t& id) const noexcept;
    void add_bridge(const Input& input, const Line& line, int from, int to) noexcept;
    static constexpr int kEvidenceReach = 2;
    /// For orders up to kEvidenceReach from a component's own.
    using Evidence = std::array<std::int32_t, 2 * kEvidenceReach + 1>;
    struct Sample {
        int x = 0;
        int y = 0;
        float value = 0.0F;
    };

    void find_bridges(const Input& input) noexcept;
    void count_shadows(const Input& input) noexcept;
    void bridge_line(const Input& input, int line) noexcept;
    void add_joint(const Input& input, const Line& line, int from, int to) noexcept;
    void join_line(const Input& input, int number, bool along_x) noexcept;
    [[nodiscard]] float value_at(const Input& input, int x, int y,
                                 std::uint16_t& id) const noexcept;
    void sample(const Input& input, const PhaseComponent& component) noexcept;
    void vote(const Input& input, const Sample& sample) noexcept;
    /// That orders must be in front of what is known to be behind.
    void vote_behind(const Input& input, const Sample& sample) noexcept;
    [[nodiscard]] bool in_front(int order) const noexcept;
    [[nodiscard]] bool is_possible(int order) const noexcept;
    [[nodiscard]] bool uncovered(int order) const noexcept;
    /// The order of something new that nothing is known of.
    [[nodiscard]] int newcomer() const noexcept;
    void remember(const Input& input, std::size_t index) noexcept;
    [[nodiscard]] float turns_at(const Sample& sample, float distance) const noexcept;
    [[nodiscard]] float distance_of(int order) const noexcept;
    [[nodiscard]] float known_behind(const Input& input, const Sample& sample) const noexcept;
    void vote_bridges(const Input& input, std::uint16_t id) noexcept;
    [[nodiscard]] bool beside_largest(const Input& input, std::size_t index) const noexcept;
    // component_evidence.cpp
    void hear(std::uint16_t id_before, int order) noexcept;
    void keep_evidence(std::size_t index) noexcept;
    [[nodiscard]] int evidence_of(int order) const noexcept;
    [[nodiscard]] int best_told(int least, int most) const noexcept;
    [[nodiscard]] bool is_convincing(int order, int least, int most) const noexcept;
    void decide(const Input& input, std::size_t index) noexcept;

    Size size_;
    bool along_x_ = true;
    bool metric_ = false;
    Image<float> low_turns_;  ///< of the working volume, on the grid
    Image<float> high_turns_;
    bool far_is_low_ = true;
    std::vector<std::int32_t> orders_;
    std::vector<std::uint8_t> ambiguous_, ambiguous_before_;
    /// In how many images on end shadows have said otherwise.
    std::vector<std::uint8_t> doubts_, doubts_before_;
    std::vector<Evidence> evidence_, evidence_before_;
    int doubt_ = 0;  ///< of the component at hand, a frame ago
    std::vector<Sample> samples_;
    float mean_ = 0.0F;         ///< value of the samples
    float most_height_ = 0.0F;  ///< turns
    std::vector<Bridge> bridges_;
    Votes home_, possible_, before_, sure_before_, bridged_, sure_bridged_, behind_, goes_on_,
        rough_, joined_, heard_;
    int touch_misses_ = 0;
    int joint_misses_ = 0;
    double front_ = 0.0;      ///< Input::front, of depths too
    float known_off_ = 0.0F;  ///< sum over the samples of which something is known: known - value
    int known_samples_ = 0;
    int nearest_known_ = 0;  ///< of the component at hand: front_ times an order must reach it
    bool moving_ = false;    ///< all components are of what moves; the rest stands still
    /// How far away the largest surface is that all is before; empty: heights are before 0, or
    /// nobody knows. And the largest thing that moved last.
    std::optional<float> backdrop_;
    std::optional<float> recent_;
    int bridge_misses_ = 0;
    double standing_out_ = 0.0;
    int shadows_ = 0;
};

}  // namespace xtrack
