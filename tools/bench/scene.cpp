// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

namespace xtrack::tools::bench {

namespace {

constexpr double kFocalPerWidth = 600.0 / 640.0;  // a field of view of 56 degrees
constexpr double kBaseline_mm = 200.0;
constexpr Size kProjectorSize{1280, 800};
constexpr double kProjectorFocal_px = 1000.0;
// Shifted, as projectors' lenses are, so that the light covers the camera's image of the wall.
constexpr double kProjectorCentre_px = 354.0;
constexpr double kNear_mm = 500.0;
constexpr double kFar_mm = 950.0;
constexpr double kWall_mm = 700.0;
constexpr double kWallSlope = 0.1;  // mm of depth a mm to the right
constexpr double kFinePerCoarse = 8.0;
constexpr double kFringe_px = 32.0;  // of the recordings that the paper's way is measured on
constexpr double kBump_mm = 40.0;
constexpr double kDark_grey = 30.0;
constexpr double kContrast_grey = 180.0;
constexpr double kNoDepth_mm = std::numeric_limits<double>::infinity();

double median(std::vector<double> values) {
    if (values.empty()) {
        return kNoDepth_mm;
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

FrameRing::FrameRing(const std::vector<Frame>& set) : set_size_(set.size()) {
    while (bytes_ <= kLeastBytes) {
        for (const Frame& frame : set) {
            frames_.push_back(std::make_shared<const Frame>(frame));
            bytes_ += static_cast<std::size_t>(frame.pixels.stride()) *
                      static_cast<std::size_t>(frame.pixels.height());
        }
    }
}

std::span<const FramePtr> FrameRing::next() noexcept {
    const std::span<const FramePtr> set(frames_.data() + next_, set_size_);
    next_ = (next_ + set_size_) % frames_.size();
    return set;
}

Result<Scene> Scene::create(Size image) {
    Scene scene;
    Rig& rig = scene.rig_;
    const double focal_px = kFocalPerWidth * image.width;
    rig.camera.matrix << focal_px, 0.0, 0.5 * image.width, 0.0, focal_px, 0.5 * image.height, 0.0,
        0.0, 1.0;
    rig.camera.size = image;
    Pinhole projector;
    projector.matrix << kProjectorFocal_px, 0.0, kProjectorCentre_px, 0.0, kProjectorFocal_px,
        0.5 * kProjectorSize.height, 0.0, 0.0, 1.0;
    projector.size = kProjectorSize;
    rig.projector = projector;
    rig.projector_from_camera_T << kBaseline_mm, 0.0, 0.0;
    rig.working_volume = WorkingVolume{kNear_mm, kFar_mm};
    if (auto ok = validate(rig); !ok) {
        return ok.error();
    }
    const auto unique_px = volume_wide_period_px(rig, Axis::x);
    if (!unique_px) {
        return unique_px.error();
    }
    const double coarse_px = std::ceil(*unique_px);
    const double fine_px = coarse_px / kFinePerCoarse;
    scene.three_step_ = three_step_sequence(Axis::x, kProjectorSize, coarse_px);
    scene.dual_ = dual_sequence(Axis::x, kProjectorSize, coarse_px, fine_px);
    scene.gray_code_ = gray_code_sequence(Axis::x, kProjectorSize, fine_px);
    scene.fringes_ = three_step_sequence(Axis::x, kProjectorSize, kFringe_px);
    return scene;
}

double Scene::wall_mm(int u) const noexcept {
    const double ray_x = (u - rig_.camera.matrix(0, 2)) / rig_.camera.matrix(0, 0);
    return kWall_mm / (1.0 - kWallSlope * ray_x);
}

double Scene::coordinate_of_depth_px(int u, double z_mm) const noexcept {
    const double ray_x = (u - rig_.camera.matrix(0, 2)) / rig_.camera.matrix(0, 0);
    return kProjectorFocal_px * (ray_x + kBaseline_mm / z_mm) + kProjectorCentre_px;
}

double Scene::coordinate_px(int u) const noexcept { return coordinate_of_depth_px(u, wall_mm(u)); }

double Scene::volume_middle_px(int u) const noexcept {
    return 0.5 * (coordinate_of_depth_px(u, kNear_mm) + coordinate_of_depth_px(u, kFar_mm));
}

double Scene::bumpy_wall_mm(int u, int v) const noexcept {
    const double x = static_cast<double>(u) / size().width;
    const double y = static_cast<double>(v) / size().height;
    return wall_mm(u) - kBump_mm * std::sin(9.0 * x) * std::cos(7.0 * y);
}

template <typename Depth>
std::vector<Frame> Scene::render(const PatternSequence& patterns, Depth z_mm) const {
    std::vector<Frame> set;
    std::mt19937 random(1);
    for (std::size_t n = 0; n < patterns.patterns.size(); ++n) {
        Frame frame;
        frame.sequence = n;
        frame.stamp = Stamp::from_us(16'667 * static_cast<std::int64_t>(n));
        frame.pattern = static_cast<int>(n);
        frame.clean_row_end = size().height;
        frame.pixels.resize(size().width, size().height);
        for (int u = 0; u < size().width; ++u) {
            for (int v = 0; v < size().height; ++v) {
                const double coordinate = coordinate_of_depth_px(u, z_mm(u, v));
                const double light = intensity(patterns.patterns[n], coordinate);
                const auto grey =
                    static_cast<int>(std::lround(kDark_grey + kContrast_grey * light));
                const int noise_grey = static_cast<int>(random() % 3U) - 1;
                frame.pixels.at(u, v) = static_cast<std::uint8_t>(grey + noise_grey);
            }
        }
        set.push_back(std::move(frame));
    }
    return set;
}

std::vector<Frame> Scene::frames(const PatternSequence& patterns) const {
    return render(patterns, [this](int u, int) { return wall_mm(u); });
}

std::vector<Frame> Scene::bumpy_frames(const PatternSequence& patterns) const {
    return render(patterns, [this](int u, int v) { return bumpy_wall_mm(u, v); });
}

template <typename Depth>
double Scene::median_error_of(const DepthFrame& depth, Depth z_mm) const {
    std::vector<double> errors_mm;
    for (int v = 0; v < depth.depth.height(); ++v) {
        for (int u = 0; u < depth.depth.width(); ++u) {
            const std::uint16_t steps = depth.depth.at(u, v);
            errors_mm.push_back(steps == 0 ? kNoDepth_mm
                                           : std::fabs(steps * depth.depth_unit_mm - z_mm(u, v)));
        }
    }
    return median(std::move(errors_mm));
}

double Scene::median_error_mm(const DepthFrame& depth) const {
    return median_error_of(depth, [this](int u, int) { return wall_mm(u); });
}

double Scene::median_bumpy_error_mm(const DepthFrame& depth) const {
    return median_error_of(depth, [this](int u, int v) { return bumpy_wall_mm(u, v); });
}

double Scene::median_error_mm(std::span<const float> xyz_mm) const {
    std::vector<double> errors_mm;
    int u = 0;
    for (std::size_t i = 2; i < xyz_mm.size(); i += 3) {
        const auto z_mm = static_cast<double>(xyz_mm[i]);
        errors_mm.push_back(std::isfinite(z_mm) ? std::fabs(z_mm - wall_mm(u)) : kNoDepth_mm);
        u = (u + 1) % size().width;
    }
    return median(std::move(errors_mm));
}

}  // namespace xtrack::tools::bench
