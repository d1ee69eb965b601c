// SPDX-License-Identifier: Apache-2.0
// Writes the small recording tests/data/sim-swipe: a simulated hand swipes to the left, 320x240,
// 60 images a second, with its label. Usage: make_sim_swipe NEW_FOLDER
#include <cstdio>
#include <string>

#include <xtrack/labels.hpp>
#include <xtrack/recording.hpp>
#include <xtrack/sim.hpp>

namespace {

using xtrack::Error;
using xtrack::Result;

constexpr double kScale = 0.5;  // of the preset's 640x480
constexpr double kBefore_s = 0.2;
constexpr xtrack::Stamp kFirst = xtrack::Stamp::from_us(1'400'000);  // the wind-up takes long
constexpr double kEnd_s = 2.45;
constexpr double kFullWell_e = 150000.0;  // little noise: it does not compress
constexpr double kReadNoise_e = 40.0;

xtrack::SimSettings settings() {
    xtrack::SimSettings s = *xtrack::SimSettings::preset("ideal-60");
    s.rig.camera.size = {320, 240};
    s.rig.camera.matrix *= kScale;
    s.rig.camera.matrix(2, 2) = 1.0;
    s.camera.full_well_e = kFullWell_e;
    s.camera.read_noise_e = kReadNoise_e;
    s.seed = 7;
    s.duration_s = kEnd_s;
    s.script = {{xtrack::SimAction::idle, xtrack::SimHand::right, 0.0, kBefore_s},
                {xtrack::SimAction::swipe_left, xtrack::SimHand::right}};
    return s;
}

Result<void> write(const std::string& folder) {
    auto rig = xtrack::SimulatedRig::create(settings());
    if (!rig) {
        return rig.error();
    }
    xtrack::RecordingWriter::Setup setup;
    setup.rig = (*rig)->rig();
    setup.patterns = (*rig)->patterns();
    auto writer = xtrack::RecordingWriter::create(folder, setup);
    if (!writer) {
        return writer.error();
    }
    for (auto item = (*rig)->next({}); item.status == xtrack::SourceStatus::ok;
         item = (*rig)->next({})) {
        if (item.frame->stamp < kFirst) {
            continue;
        }
        if (auto added = writer->add(*item.frame); !added) {
            return added;
        }
    }
    std::vector<xtrack::GestureLabel> labels;
    for (const xtrack::SimLabel& label : (*rig)->labels()) {
        labels.push_back(
            {label.gesture, xtrack::Chirality::right, label.start, label.end, label.commit});
    }
    if (auto added = writer->add_text("labels.csv", xtrack::labels_text(labels)); !added) {
        return added;
    }
    return writer->close();
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: make_sim_swipe NEW_FOLDER\n");
        return 2;
    }
    if (const auto written = write(argv[1]); !written) {
        std::fprintf(stderr, "make_sim_swipe: %s\n", written.error().message.c_str());
        return 1;
    }
    return 0;
}
