// SPDX-License-Identifier: Apache-2.0
#include "tools/corpus/noise.hpp"

namespace xtrack::tools::corpus {

const char* to_string(View view) noexcept {
    switch (view) {
        case View::fine: return "depth, fine";
        case View::coarse: return "depth, coarse";
        case View::joints: return "joints";
    }
    return "unknown";
}

// `xtrack corpus --measure-noise --people 6`.
const Noise& noise_of(View view) noexcept {
    static const Noise fine = [] {
        Noise n;
        n.palm_aside_mm = {1.0, 2.0};
        n.palm_deep_mm = {1.0, 2.0};
        n.outlier_share = {0.005, 0.01};
        n.outlier_mm = 8.0;
        n.tip_mm = {1.5, 3.0};
        n.extension = {0.03, 0.06};
        n.lost_share = {0.002, 0.01};
        n.lost_ms = 60.0;
        n.tip_valid = {0.5, 0.6, 0.8, 0.95, 0.98};
        n.hidden_tip_valid = 0.1;
        n.aperture_known = {0.9, 0.9, 0.95, 0.95};
        n.aperture_off_mm = {3.0, 0.0, 0.0, 0.0};
        n.aperture_mm = {2.0, 3.0, 3.0, 4.0};
        n.grab = 0.05;
        n.normal_rad = 0.05;
        n.chirality_unknown = 0.01;
        n.chirality_wrong = 0.02;
        return n;
    }();
    static const Noise coarse = [] {
        Noise n = fine;
        n.palm_aside_mm = {2.0, 6.0};
        n.palm_deep_mm = {2.0, 5.0};
        n.outlier_share = {0.02, 0.06};
        n.outlier_mm = 25.0;
        n.lost_share = {0.01, 0.05};
        n.lost_ms = 120.0;
        return n;
    }();
    // No rig of ours gives joints; of a headset's, what the recordings of others jitter by.
    static const Noise joints = [] {
        Noise n;
        n.palm_aside_mm = {1.0, 1.5};
        n.palm_deep_mm = {1.5, 2.5};
        n.tip_mm = {1.0, 1.5};
        n.lost_share = {0.001, 0.003};
        n.lost_ms = 100.0;
        n.confidence = 0.95;
        n.chirality_wrong = 0.005;
        return n;
    }();
    switch (view) {
        case View::fine: return fine;
        case View::coarse: return coarse;
        case View::joints: break;
    }
    return joints;
}

}  // namespace xtrack::tools::corpus
