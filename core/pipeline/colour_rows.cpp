// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include "core/pipeline/depth_decoder_impl.hpp"

namespace xtrack {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr int kClipped = 255;
constexpr int kStep = ColourPalette::kSampleStepPx;
constexpr int kCell = ColourPalette::kCellPx;

bool clipped(const std::uint8_t* bgr) noexcept {
    return std::max({bgr[0], bgr[1], bgr[2]}) >= kClipped;
}

ColourPeriod colour_period(const SinePlan& sine) {
    return {sine.period_px, sine.phases_rad.front()};
}

}  // namespace

Result<void> DepthDecoder::Impl::prepare_colours() {
    const SinePlan& fine = plan.sines.back();
    std::array<double, 3> phases{};
    std::copy_n(fine.phases_rad.begin(), phases.size(), phases.begin());
    auto model =
        ColourModel::create(phases, rig.camera_from_projector_rgb.value_or(Mat3d::Identity()));
    if (!model) {
        return model.error();
    }
    colours = *model;
    std::optional<ColourPeriod> coarse;
    if (const SinePlan* reference = plan.colour_reference(); reference != nullptr) {
        coarse = colour_period(*reference);
    }
    const Size samples = ColourPalette::samples(size);
    Image<float> first_px(samples.width, samples.height);
    Image<float> last_px(samples.width, samples.height);
    for (int j = 0; j < samples.height; ++j) {
        for (int i = 0; i < samples.width; ++i) {
            VolumeReach reach{0.0, static_cast<double>(plan.coded_length_px)};
            if (geometry) {
                reach = geometry->reach(i * kStep, j * kStep).value_or(reach);
            }
            first_px.at(i, j) = static_cast<float>(std::min(reach.near_px, reach.far_px));
            last_px.at(i, j) = static_cast<float>(std::max(reach.near_px, reach.far_px));
        }
    }
    palette.emplace(size, colours, colour_period(fine), coarse, first_px, last_px);
    for (Scratch& scratch : scratches) {
        scratch.taps.resize(size.width, static_cast<int>(ColourModel::kTaps));
    }
    return {};
}

// The newest images of the colour periods that saw row y cleanly.
DepthDecoder::Impl::ColourRow DepthDecoder::Impl::colour_row(int y) const noexcept {
    ColourRow row;
    const SinePlan* coarse = plan.colour_reference();
    const Frame* fine_frame = window.clean(plan.sines.back().patterns.front(), y);
    const Frame* coarse_frame =
        coarse == nullptr ? fine_frame : window.clean(coarse->patterns.front(), y);
    if (fine_frame == nullptr || coarse_frame == nullptr) {
        return row;
    }
    row.fine = fine_frame->pixels.row(y);
    row.coarse = coarse_frame->pixels.row(y);
    if (coarse != nullptr && moves()) {
        const Shift shift = motion->to(*coarse_frame);
        const int at = y + shift.dy;
        if (at >= 0 && at < size.height && saw(*coarse_frame, at)) {
            row.moved = coarse_frame->pixels.row(at);
            row.moved_dx = shift.dx;
            row.cell_y = std::min(y / MotionEstimator::kCellPx, motion->cells_y() - 1);
        }
    }
    if (settings.order == OrderSource::depth_image) {
        row.reference_px = order_px.row(y);
    } else if (plan.sines.size() == 2 && coarse != nullptr && !plan.gray &&
               settings.order == OrderSource::automatic) {
        row.reference_px = order.row(y);
    }
    return row;
}

void DepthDecoder::Impl::sample_colours(const ColourRow& row, int x, std::size_t at,
                                        const ColourSamplesOut& out,
                                        const std::array<float*, 3>& moved) const noexcept {
    ColourModel::Light fine = ColourModel::Light::Zero();
    ColourModel::Light coarse = ColourModel::Light::Zero();
    const std::ptrdiff_t pixel = static_cast<std::ptrdiff_t>(3) * x;
    if (row.fine != nullptr && !clipped(row.fine + pixel) && !clipped(row.coarse + pixel)) {
        fine = colours.light(row.fine + pixel);
        coarse = colours.light(row.coarse + pixel);
    }
    for (int k = 0; k < 3; ++k) {
        out.fine[static_cast<std::size_t>(k)][at] = fine[k];
        out.coarse[static_cast<std::size_t>(k)][at] = coarse[k];
    }
    ColourModel::Light other = ColourModel::Light::Zero();
    const int there = x + row.moved_dx;
    if (row.moved != nullptr && there >= 0 && there < size.width &&
        motion->disturbed(std::min(x / MotionEstimator::kCellPx, motion->cells_x() - 1),
                          row.cell_y)) {
        const std::uint8_t* bgr = row.moved + static_cast<std::ptrdiff_t>(3) * there;
        other = clipped(bgr) ? other : colours.light(bgr);
    }
    for (std::size_t k = 0; k < 3; ++k) {
        moved[k][at] = other[static_cast<int>(k)];
    }
    out.reference_px[at] = row.reference_px == nullptr ? kNone : row.reference_px[x];
}

void DepthDecoder::Impl::choose_surfaces() noexcept {
    palette->begin(coarse_drift_px());
    // Cells are summed up row by row, so a band is whole cells.
    team->run(0, size.height, kCell, [this](int, int first, int last) {
        for (int y = first; y < last; y += kStep) {
            const ColourRow row = colour_row(y);
            const ColourSamplesOut out = palette->row(y);
            const std::array<float*, 3> moved = palette->moved_row(y);
            for (int x = 0; x < size.width; x += kStep) {
                sample_colours(row, x, static_cast<std::size_t>(x / kStep), out, moved);
            }
            palette->add_row(y);
        }
    });
    palette->choose();
}

void DepthDecoder::Impl::draw_borders(int first_cell_y, int last_cell_y) noexcept {
    constexpr int kSide = ColourPalette::kFineSamples;
    constexpr int kFine = ColourPalette::kFineStepPx;
    constexpr std::size_t kCount = static_cast<std::size_t>(kSide) * kSide;
    std::array<std::array<float, kCount>, 10> planes;
    const std::array<float*, 3> moved{planes[7].data(), planes[8].data(), planes[9].data()};
    const ColourSamplesOut out{{planes[0].data(), planes[1].data(), planes[2].data()},
                               {planes[3].data(), planes[4].data(), planes[5].data()},
                               planes[6].data()};
    const ColourSamples samples{{planes[0].data(), planes[1].data(), planes[2].data()},
                                {planes[3].data(), planes[4].data(), planes[5].data()},
                                planes[6].data()};
    for (int cy = first_cell_y; cy < last_cell_y; ++cy) {
        std::array<ColourRow, kSide> rows;
        for (int j = 0; j < kSide; ++j) {
            rows[static_cast<std::size_t>(j)] =
                colour_row(std::clamp(cy * kCell + (j - 1) * kFine, 0, size.height - 1));
        }
        for (int cx = 0; cx < palette->cells_x(); ++cx) {
            if (!palette->at_border(cx, cy)) {
                continue;
            }
            std::size_t at = 0;
            for (const ColourRow& row : rows) {
                for (int i = -1; i < kSide - 1; ++i) {
                    const int x = std::clamp(cx * kCell + i * kFine, 0, size.width - 1);
                    sample_colours(row, x, at++, out, moved);
                }
            }
            palette->draw_border(cx, cy, samples, {moved[0], moved[1], moved[2]});
        }
    }
}

bool DepthDecoder::Impl::moves() const noexcept {
    return settings.motion == MotionHandling::follow && motion && motion->moving();
}

// How far the coordinates of what moves were from where they are now, when the coarse image came.
float DepthDecoder::Impl::coarse_drift_px() const noexcept {
    const SinePlan* coarse = plan.colour_reference();
    const Frame* frame = coarse == nullptr ? nullptr : window.newest(coarse->patterns.front());
    return frame == nullptr || !moves() ? 0.0F : static_cast<float>(drift_px_since(*frame));
}

void DepthDecoder::Impl::decode_moved_colours(int y, const RowOut& out, Scratch& scratch) noexcept {
    constexpr int kFine = ColourPalette::kFineStepPx;
    const std::uint8_t* surfaces = palette->surfaces().row(y / kFine);
    const RowOut moved{scratch.moving_phase.row(0), scratch.moving_modulation.row(0),
                       scratch.moving_coordinate.row(0)};
    bool decoded = false;
    for (int x = 0; can_follow && x < size.width; ++x) {
        if (!ColourPalette::is_moved(surfaces[x / kFine])) {
            continue;
        }
        if (!decoded) {
            decode_row_chain(following, y, moved, scratch);
            decoded = true;
        }
        out.phase[x] = moved.phase[x];
        out.modulation[x] = moved.modulation[x];
        out.coordinate[x] = moved.coordinate[x];
    }
}

void DepthDecoder::Impl::tell_surfaces() noexcept {
    choose_surfaces();
    while (!palette->settled()) {
        palette->learn();
        choose_surfaces();
    }
    team->run(0, palette->cells_y(), 1,
              [this](int, int first, int last) { draw_borders(first, last); });
    for (Scratch& scratch : scratches) {
        scratch.row_of_taps = -1;
    }
}

// The taps of each pixel's surface.
void DepthDecoder::Impl::colours_of_row(int y, Scratch& scratch) const noexcept {
    constexpr int kFine = ColourPalette::kFineStepPx;
    if (y / kFine == scratch.row_of_taps) {
        return;
    }
    scratch.row_of_taps = y / kFine;
    const std::uint8_t* surfaces = palette->surfaces().row(scratch.row_of_taps);
    for (int begin = 0; begin < size.width;) {
        int end = begin + 1;
        const std::size_t surface = ColourPalette::surface_of(surfaces[begin / kFine]);
        while (end < size.width && ColourPalette::surface_of(surfaces[end / kFine]) == surface) {
            ++end;
        }
        const ColourModel::Taps& taps = palette->taps(surface);
        for (std::size_t t = 0; t < taps.size(); ++t) {
            std::fill(scratch.taps.row(static_cast<int>(t)) + begin,
                      scratch.taps.row(static_cast<int>(t)) + end, taps[t]);
        }
        begin = end;
    }
}

}  // namespace xtrack
