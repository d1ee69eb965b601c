// SPDX-License-Identifier: Apache-2.0
#include "core/depth/order_reference.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace xtrack {
namespace {

// Share of the volume's reach that a period must cover.
constexpr double kMinUniqueShare = 0.9;
// Noise at the ends of the volume, as a share of its reach: at 6 grey levels of modulation the
// phase is good to 0.25 rad, 4 % of a turn; two and a half sigma.
constexpr double kNoiseShare = 0.1;

Error repeats(double period_px, const std::string& why) {
    const auto px = std::to_string(static_cast<int>(std::lround(period_px)));
    return Error{ErrorCode::unsupported, "pattern sequence: its longest period of " + px +
                                             " px repeats " + why +
                                             "; add a longer period or a Gray code, give the order "
                                             "from a depth image, or unwrap in space"};
}

}  // namespace

Result<OrderReference> OrderReference::create(const Triangulation* geometry, Size image,
                                              double period_px, int coded_length_px) {
    OrderReference reference;
    const int entries = (image.height + kRowsPerEntry - 1) / kRowsPerEntry;
    reference.middle_px_.resize(image.width, entries);
    const double last_px = coded_length_px - 0.5;
    constexpr double kFirstPx = -0.5;
    if (period_px >= coded_length_px) {
        reference.middle_px_.fill(static_cast<float>(0.5 * (kFirstPx + last_px)));
        return reference;
    }
    if (geometry == nullptr || !geometry->reach(0, 0)) {
        return repeats(period_px, "on the projector, and the rig names no working_volume_mm");
    }
    double widest_px = 0.0;
    for (int entry = 0; entry < entries; ++entry) {
        const int v = std::min(entry * kRowsPerEntry + kRowsPerEntry / 2, image.height - 1);
        float* row = reference.middle_px_.row(entry);
        for (int u = 0; u < image.width; ++u) {
            const VolumeReach reach = *geometry->reach(u, v);
            const double near = std::clamp(reach.near_px, kFirstPx, last_px);
            const double far = std::clamp(reach.far_px, kFirstPx, last_px);
            const double length = std::fabs(far - near);
            widest_px = std::max(widest_px, length);
            row[u] = static_cast<float>(0.5 * (near + far));
        }
    }
    if (period_px < kMinUniqueShare * widest_px) {
        return repeats(period_px, "inside the working volume, which spans " +
                                      std::to_string(static_cast<int>(std::lround(widest_px))) +
                                      " px");
    }
    const double ambiguous = std::max(0.0, widest_px * (1.0 + kNoiseShare) - period_px) / period_px;
    reference.tolerance_ = static_cast<float>(0.5 - 0.5 * ambiguous);
    return reference;
}

}  // namespace xtrack
