// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include <xtrack/recording.hpp>

namespace xtrack {

/// A folder of its own for each test, empty before and removed after it.
class RecordingTest : public testing::Test {
 protected:
    RecordingTest() {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::path(testing::TempDir()) /
                  (std::string("xtrack_") + test->test_suite_name() + "_" + test->name());
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    ~RecordingTest() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path folder_;
};

inline Rig small_rig() {
    Rig rig;
    rig.camera.matrix << 20.5, 0.0, 7.9, 0.0, 20.25, 6.1, 0.0, 0.0, 1.0;
    rig.camera.distortion[0] = -0.058035265654325485;
    rig.camera.size = {16, 12};
    rig.projector.emplace();
    rig.projector->matrix << 1000.0, 0.0, 512.0, 0.0, 1000.0, 384.0, 0.0, 0.0, 1.0;
    rig.projector->size = {1024, 768};
    rig.projector_from_camera_T = {-15.10369659640191, 174.0, 1e-5};
    rig.interaction_from_camera = Mat4d::Identity();
    (*rig.interaction_from_camera)(0, 0) = -1.0;
    rig.working_volume = WorkingVolume{600.0, 2000.0};
    return rig;
}

/// A frame of 16x12 pixels, each of another value.
inline Frame small_frame(int number, int pattern, PixelFormat format = PixelFormat::grey8) {
    Frame frame;
    frame.format = format;
    frame.stamp = Stamp::from_us(number * 16667);
    frame.sequence = static_cast<std::uint64_t>(number);
    frame.pattern = pattern;
    frame.pixels.resize(16 * frame.channels(), 12);
    for (int y = 0; y < 12; ++y) {
        for (int x = 0; x < frame.pixels.width(); ++x) {
            frame.pixels.at(x, y) = static_cast<std::uint8_t>((x * 31 + y * 17 + number * 7) % 256);
        }
    }
    return frame;
}

inline std::string text_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

inline void set_text(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
}

}  // namespace xtrack
