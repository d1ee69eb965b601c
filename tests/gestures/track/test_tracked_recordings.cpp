// SPDX-License-Identifier: Apache-2.0
// Judges the tracker on recordings that lie outside the project, in ../shared/data, where they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <xtrack/hand_tracker.hpp>
#include <xtrack/recording.hpp>

namespace xtrack {
namespace {

namespace fs = std::filesystem;

std::vector<std::vector<std::string>> read_table(const fs::path& file) {
    std::vector<std::vector<std::string>> rows;
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
        std::vector<std::string> row;
        std::stringstream fields(line);
        std::string field;
        while (std::getline(fields, field, ',')) {
            row.push_back(field);
        }
        rows.push_back(row);
    }
    return rows;
}

struct Truth {
    Vec3f palm_mm;
    std::array<Vec3f, kFingerCount> tips_mm;
};

std::map<std::int64_t, Truth> read_truth(const fs::path& file) {
    std::map<std::int64_t, Truth> out;
    for (const auto& row : read_table(file)) {
        const auto point = [&](std::size_t k) {
            return Vec3f(std::stof(row[k]), std::stof(row[k + 1]), std::stof(row[k + 2]));
        };
        Truth& truth = out[std::stoll(row[0])];
        truth.palm_mm = point(2);
        for (std::size_t f = 0; f < kFingerCount; ++f) {
            truth.tips_mm[f] = point(5 + 6 * f);
        }
    }
    return out;
}

/// What real depth does: noise, holes, and depth between two surfaces at their edges.
void degrade(DepthFrame& frame, unsigned seed) {
    constexpr double kNoiseMm = 2.0;
    constexpr double kMissing = 0.2;
    constexpr double kFlying = 0.5;
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, kNoiseMm / frame.depth_unit_mm);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const Image<std::uint16_t> clean = frame.depth;
    for (int y = 1; y + 1 < clean.height(); ++y) {
        for (int x = 1; x + 1 < clean.width(); ++x) {
            const int d = clean.at(x, y);
            if (d == 0) {
                continue;
            }
            const int beside = uniform(random) < 0.5 ? clean.at(x - 1, y) : clean.at(x + 1, y);
            double v = d + noise(random);
            if (beside == 0 || std::abs(beside - d) * frame.depth_unit_mm > 30.0) {
                const double other = beside == 0 ? 1.3 * d : beside;
                v = uniform(random) < kFlying ? d + uniform(random) * (other - d) : 0.0;
            }
            v = uniform(random) < kMissing ? 0.0 : std::clamp(v, 0.0, 65535.0);
            frame.depth.at(x, y) = static_cast<std::uint16_t>(v);
        }
    }
}

double quantile(std::vector<double> v, double q) {
    if (v.empty()) {
        return -1.0;
    }
    std::sort(v.begin(), v.end());
    return v[static_cast<std::size_t>(q * static_cast<double>(v.size() - 1))];
}

fs::path shared(const std::string& name) { return fs::path(XTRACK_SHARED_DATA) / name; }

// NOLINTBEGIN(bugprone-macro-parentheses): it declares `reader`
#define OPEN_OR_SKIP(name, reader)                                        \
    if (!fs::exists(shared(name))) {                                      \
        GTEST_SKIP() << shared(name) << " is not there";                  \
    }                                                                     \
    Result<RecordingReader> opened = RecordingReader::open(shared(name)); \
    ASSERT_TRUE(opened.ok()) << opened.error().message;                   \
    const RecordingReader& reader = opened.value()
// NOLINTEND(bugprone-macro-parentheses)

class Rendered : public testing::TestWithParam<std::tuple<const char*, bool>> {};

TEST_P(Rendered, HandIsWhereTheTruthIs) {
    const auto [name, degraded] = GetParam();
    OPEN_OR_SKIP(std::string("rendered/") + name, reader);
    const auto truths = read_truth(*reader.truth_hands_file());
    Result<HandTracker> made = HandTracker::create(reader.rig(), reader.image_size());
    ASSERT_TRUE(made.ok());
    HandTracker tracker = std::move(made.value());
    DepthFrame depth;
    Image<std::uint8_t> mask;
    std::vector<double> palm_mm, tip_mm, iou;
    std::size_t frames = 0, seen = 0, named = 0, tips = 0, right = 0;
    std::set<int> ids;
    for (std::size_t i = 0; i < reader.entries().size(); ++i) {
        const Stamp stamp = reader.entries()[i].stamp;
        if (!reader.has_truth_depth(i) || truths.count(stamp.us()) == 0) {
            continue;
        }
        ASSERT_TRUE(reader.read_truth_depth(i, depth).ok());
        depth.stamp = stamp;
        if (degraded) {
            degrade(depth, static_cast<unsigned>(i));
        }
        ++frames;
        const HandFrame& hands = tracker.track(depth);
        if (hands.count == 0) {
            continue;
        }
        ++seen;
        const Hand& hand = hands.hands[0];
        const Truth& truth = truths.at(stamp.us());
        ids.insert(hand.id);
        right += hand.chirality == Chirality::right ? 1 : 0;
        palm_mm.push_back((hand.palm_mm - truth.palm_mm).norm());
        for (std::size_t f = 0; f < kFingerCount; ++f) {
            if (hand.fingertips[f].valid) {
                const double error = (hand.fingertips[f].position_mm - truth.tips_mm[f]).norm();
                tip_mm.push_back(error);
                ++tips;
                named += error < 20.0 ? 1 : 0;
            }
        }
        if (reader.has_truth_mask(i)) {
            ASSERT_TRUE(reader.read_truth_mask(i, mask).ok());
            const HandSegmentation s = tracker.segmentation();
            double both = 0.0, either = 0.0;
            for (int y = 0; y < s.labels.height * s.scale; ++y) {
                for (int x = 0; x < s.labels.width * s.scale; ++x) {
                    const bool a = mask.at(x, y) == 1;
                    const bool b = s.labels.at(x / s.scale, y / s.scale) == s.regions[0].label;
                    both += a && b ? 1.0 : 0.0;
                    either += a || b ? 1.0 : 0.0;
                }
            }
            iou.push_back(both / either);
        }
    }
    std::printf(
        "%-20s %-8s %zu of %zu frames, %zu ids, right %zu, palm %.1f / %.1f mm, tips %.1f / "
        "%.1f mm, named %zu of %zu, IoU %.3f\n",
        name, degraded ? "degraded" : "clean", seen, frames, ids.size(), right,
        quantile(palm_mm, 0.5), quantile(palm_mm, 0.95), quantile(tip_mm, 0.5),
        quantile(tip_mm, 0.95), named, tips, quantile(iou, 0.5));
    ASSERT_GT(frames, 0U);
    EXPECT_EQ(seen, frames);
    EXPECT_EQ(ids.size(), 1U);
    EXPECT_LT(quantile(palm_mm, 0.95), 15.0);
    EXPECT_LT(quantile(tip_mm, 0.5), 5.0);
    EXPECT_GT(static_cast<double>(named), 0.9 * static_cast<double>(tips));
    EXPECT_GT(static_cast<double>(tips), 4.5 * static_cast<double>(frames));
    EXPECT_GT(quantile(iou, 0.5), 0.9);
}

INSTANTIATE_TEST_SUITE_P(Shared, Rendered,
                         testing::Combine(testing::Values("swipe-left-dual-60",
                                                          "grey-swipe-left-60", "push-three-60",
                                                          "rgb-push-30", "static-dual"),
                                          testing::Bool()));

TEST(Stills, OpenPalmsAreFound) {
    OPEN_OR_SKIP("hands/depth/stills-open-palm-sr305", reader);
    Result<HandTracker> made = HandTracker::create(reader.rig(), reader.image_size());
    ASSERT_TRUE(made.ok());
    DepthFrame depth;
    int found = 0;
    for (std::size_t i = 0; i < reader.entries().size(); ++i) {
        made->reset();
        ASSERT_TRUE(reader.read_depth(i, depth).ok());
        found += made->track(depth).count > 0 ? 1 : 0;
    }
    std::printf("open palms: %d of %zu\n", found, reader.entries().size());
    EXPECT_GE(found * 100, static_cast<int>(reader.entries().size()) * 95);
}

TEST(Stills, FingersAreCounted) {
    OPEN_OR_SKIP("hands/depth/stills-fingers-tof200", reader);
    Result<HandTracker> made = HandTracker::create(reader.rig(), reader.image_size());
    ASSERT_TRUE(made.ok());
    DepthFrame depth;
    int with_hand = 0, found = 0, exact = 0, near = 0;
    for (const auto& row : read_table(*reader.poses_file())) {
        made->reset();
        ASSERT_TRUE(reader.read_depth(static_cast<std::size_t>(std::stoi(row[0])), depth).ok());
        const HandFrame& hands = made->track(depth);
        ASSERT_GE(row.size(), 4U);
        if (row[3].starts_with("0")) {
            EXPECT_EQ(hands.count, 0U) << "nobody shows a hand in image " << row[0];
            continue;
        }
        ASSERT_FALSE(row[2].empty()) << "image " << row[0] << " has no count";
        ++with_hand;
        if (hands.count > 0) {
            ++found;
            const int off = std::abs(hands.hands[0].extended_fingers - std::stoi(row[2]));
            exact += off == 0 ? 1 : 0;
            near += off <= 1 ? 1 : 0;
        }
    }
    std::printf("fingers: hand in %d of %d, exact %d, within one %d\n", found, with_hand, exact,
                near);
    ASSERT_GT(with_hand, 0);
    EXPECT_GE(found * 100, with_hand * 95);
    EXPECT_GE(exact * 100, with_hand * 80);
    EXPECT_GE(near * 100, with_hand * 95);
}

/// While the labelled gesture runs one hand must be followed all the time.
TEST(CarClips, OneHandThroughTheStroke) {
    if (!fs::exists(shared("hands/depth"))) {
        GTEST_SKIP() << shared("hands/depth") << " is not there";
    }
    int clips = 0, held = 0;
    for (const auto& folder : fs::directory_iterator(shared("hands/depth"))) {
        const std::string name = folder.path().filename().string();
        if (name.find("move-hand") == std::string::npos && name.find("-p") == std::string::npos) {
            continue;
        }
        Result<RecordingReader> opened = RecordingReader::open(folder.path());
        ASSERT_TRUE(opened.ok()) << opened.error().message;
        if (opened->kind() != RecordingKind::depth || !opened->labels_file()) {
            continue;
        }
        const auto labels = read_table(*opened->labels_file());
        Result<HandTracker> made = HandTracker::create(opened->rig(), opened->image_size());
        ASSERT_TRUE(made.ok());
        DepthFrame depth;
        std::map<int, int> frames_of_id;
        int frames = 0, seen = 0;
        for (std::size_t i = 0; i < opened->entries().size(); ++i) {
            ASSERT_TRUE(opened->read_depth(i, depth).ok());
            const HandFrame& hands = made->track(depth);
            const std::int64_t t = depth.stamp.us();
            if (t < std::stoll(labels[0][2]) || t > std::stoll(labels[0][3])) {
                continue;
            }
            ++frames;
            seen += hands.count > 0 ? 1 : 0;
            for (const Hand& hand : hands.all()) {
                ++frames_of_id[hand.id];
            }
        }
        int longest = 0;
        for (const auto& [id, n] : frames_of_id) {
            longest = std::max(longest, n);
        }
        ++clips;
        held += longest * 2 >= frames ? 1 : 0;
        std::printf("%-38s seen in %d of %d frames, longest id %d\n", name.c_str(), seen, frames,
                    longest);
    }
    if (clips == 0) {
        GTEST_SKIP() << shared("hands/depth") << " holds no labelled clip of a driver's hand";
    }
    EXPECT_GE(held * 10, clips * 8) << "clips where one id lasts half of the gesture";
}

}  // namespace
}  // namespace xtrack
