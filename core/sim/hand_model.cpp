// SPDX-License-Identifier: Apache-2.0
#include "core/sim/hand_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace xtrack::sim {
namespace {

// Measures of an adult's hand of kModelHandLengthMm, mm; proportions after Greiner 1991 (hand
// anthropometry of US Army personnel), rounded.
const std::array<FingerRest, kSimFingerCount> kFingerRest{{
    {{{21.0F, 18.0F, 8.0F}, {48.0F, 47.0F, 13.0F}, {68.0F, 69.0F, 15.0F}, {81.0F, 86.0F, 15.0F}}},
    {{{26.0F, 85.0F, -1.0F}, {35.0F, 125.0F, 0.0F}, {40.5F, 148.0F, 1.0F}, {44.5F, 165.0F, 2.0F}}},
    {{{5.0F, 88.0F, -3.0F}, {7.0F, 133.0F, -2.0F}, {8.0F, 160.0F, -1.0F}, {8.5F, 178.0F, 0.0F}}},
    {{{-14.5F, 83.0F, -2.0F},
      {-22.0F, 124.0F, -1.0F},
      {-26.5F, 149.0F, 0.0F},
      {-29.5F, 166.0F, 1.0F}}},
    {{{-31.5F, 73.0F, 0.0F},
      {-44.0F, 104.0F, 1.0F},
      {-51.0F, 121.5F, 2.0F},
      {-57.0F, 136.5F, 3.0F}}},
}};
const std::array<std::array<float, kBonesPerFinger + 1>, kSimFingerCount> kFingerRadius{{
    {{15.0F, 11.5F, 9.8F, 8.2F}},
    {{10.6F, 9.2F, 8.0F, 7.2F}},
    {{10.8F, 9.5F, 8.2F, 7.4F}},
    {{10.2F, 8.8F, 7.7F, 7.0F}},
    {{9.0F, 7.8F, 6.9F, 6.2F}},
}};
const Vec3f kThumbPad{-0.50F, 0.30F, 0.81F};

constexpr float kFilletFingerMm = 3.0F;   // between neighbours: the web
constexpr float kFilletSegmentMm = 2.0F;  // between the segments of one finger
constexpr float kFilletPalmMm = 14.0F;
constexpr float kFilletKnuckleMm = 7.0F;
constexpr float kFilletWristMm = 18.0F;

// A forearm is wider than it is thick: its field is made in a space squeezed along z.
constexpr float kWristSqueeze = 1.45F;
constexpr float kElbowSqueeze = 1.15F;
const TaperedCapsule kForearmFlesh{{0.0F, 4.0F, 0.0F}, {0.0F, -225.0F, 0.0F}, 26.0F, 45.0F};
const TaperedCapsule kUpperArmFlesh{{0.0F, -255.0F, 0.0F}, {0.0F, -545.0F, 0.0F}, 45.0F, 58.0F};

const std::array<TaperedCapsule, 8> kPalmFlesh{{
    {{15.0F, 12.0F, 0.0F}, {26.0F, 84.0F, -1.0F}, 14.5F, 11.5F},   // second metacarpal
    {{5.0F, 12.0F, 0.0F}, {5.0F, 87.0F, -2.0F}, 15.0F, 12.0F},     // third
    {{-7.0F, 12.0F, 0.0F}, {-14.5F, 82.0F, -1.0F}, 14.5F, 11.5F},  // fourth
    {{-16.0F, 12.0F, 0.0F}, {-31.0F, 72.0F, 0.0F}, 14.0F, 10.5F},  // fifth
    {{20.0F, 17.0F, 7.0F}, {47.0F, 46.0F, 13.0F}, 15.0F, 12.5F},   // thumb's, with its ball
    {{21.0F, 24.0F, 8.0F}, {33.0F, 45.0F, 9.0F}, 13.0F, 11.0F},    // ball of the thumb
    {{-22.0F, 20.0F, 5.0F}, {-29.0F, 54.0F, 4.0F}, 13.0F, 10.0F},  // ball of the little finger
    {{38.0F, 42.0F, 8.0F}, {27.0F, 64.0F, 2.0F}, 9.5F, 9.5F},      // web of the thumb
}};

TaperedCapsule segment(std::size_t finger, std::size_t s) {
    const auto& joint = kFingerRest[finger];
    const auto& radius = kFingerRadius[finger];
    return {joint[s], joint[s + 1], radius[s], radius[s + 1]};
}

/// The thumb's metacarpal belongs to the palm's flesh.
float finger_distance(std::size_t finger, const Vec3f& p) {
    float d = distance(segment(finger, 2), p);
    d = smooth_union(d, distance(segment(finger, 1), p), kFilletSegmentMm);
    return finger == kThumb ? d
                            : smooth_union(d, distance(segment(finger, 0), p), kFilletSegmentMm);
}

float palm_distance(const Vec3f& p) {
    float d = distance(kPalmFlesh[0], p);
    for (std::size_t i = 1; i < kPalmFlesh.size(); ++i) {
        d = smooth_union(d, distance(kPalmFlesh[i], p), kFilletPalmMm);
    }
    return d;
}

float arm_distance(const Vec3f& p) {
    const float squeeze =
        kElbowSqueeze + (kWristSqueeze - kElbowSqueeze) * smooth_step(-180.0F, -10.0F, p.y());
    const Vec3f q{p.x(), p.y(), p.z() * squeeze};
    return smooth_union(distance(kForearmFlesh, q), distance(kUpperArmFlesh, q), kFilletWristMm) /
           squeeze;
}

float skin_distance(const Vec3f& p) {
    constexpr float kArmOnlyBelowMm = -60.0F;
    const float arm = arm_distance(p);
    if (p.y() < kArmOnlyBelowMm) {
        return arm;
    }
    float fingers = finger_distance(kThumb, p);
    for (std::size_t f = kIndex; f < kSimFingerCount; ++f) {
        fingers = smooth_union(fingers, finger_distance(f, p), kFilletFingerMm);
    }
    const float hand = smooth_union(palm_distance(p), fingers, kFilletKnuckleMm);
    return smooth_union(hand, arm, kFilletWristMm);
}

using Weights = std::array<float, kBoneCount>;

// Half-widths of the zones in which the skin goes from one bone to the next, mm.
constexpr float kBlendKnuckleMm = 11.0F;
constexpr float kBlendPhalanxMm = 7.5F;
constexpr float kBlendThumbRootMm = 20.0F;
constexpr float kBlendElbowMm = 45.0F;
constexpr float kWristBlendBelowMm = -48.0F;
constexpr float kWristBlendAboveMm = 22.0F;
// Skin between two fingers follows the nearer one; this says how sharply.
constexpr float kNeighbourSoftnessMm = 2.0F;
constexpr float kThumbSoftnessMm = 5.0F;

/// Splits `amount` between the bones of one finger (and the hand, before its first joint).
void add_finger(std::size_t finger, const Vec3f& p, float amount, Weights& w) {
    const auto& joint = kFingerRest[finger];
    float rest = amount;
    for (std::size_t s = 0; s < kBonesPerFinger; ++s) {
        const Vec3f before =
            s == 0 ? (joint[1] - joint[0]).normalized() : (joint[s] - joint[s - 1]).normalized();
        const Vec3f axis = (before + (joint[s + 1] - joint[s]).normalized()).normalized();
        const float half = s > 0              ? kBlendPhalanxMm
                           : finger == kThumb ? kBlendThumbRootMm
                                              : kBlendKnuckleMm;
        const float past = smooth_step(-half, half, (p - joint[s]).dot(axis));
        const std::size_t bone = s == 0 ? kHandBone : finger_bone(finger, s - 1);
        w[bone] += rest * (1.0F - past);
        rest *= past;
    }
    w[finger_bone(finger, kBonesPerFinger - 1)] += rest;
}

Weights skin_weights(const Vec3f& p) {
    Weights w{};
    const float hand = smooth_step(kWristBlendBelowMm, kWristBlendAboveMm, p.y());
    const float lower =
        smooth_step(-kForearmLengthMm - kBlendElbowMm, -kForearmLengthMm + kBlendElbowMm, p.y());
    w[kUpperArm] = 1.0F - lower;
    w[kForearm] = lower * (1.0F - hand);
    if (hand <= 0.0F) {
        return w;
    }
    // Thumb against the rest of the hand.
    const float thumb_distance =
        std::min(distance(segment(kThumb, 0), p), finger_distance(kThumb, p));
    float others = palm_distance(p) + 4.0F;  // the palm's flesh holds the thumb's metacarpal too
    for (std::size_t i = 0; i < 4; ++i) {
        others = std::min(others, distance(kPalmFlesh[i], p));
    }
    std::array<float, kSimFingerCount> d{};
    float nearest = std::numeric_limits<float>::max();
    for (std::size_t f = kIndex; f < kSimFingerCount; ++f) {
        d[f] = std::min(distance(segment(f, 0), p), finger_distance(f, p));
        nearest = std::min(nearest, d[f]);
    }
    others = std::min(others, nearest);
    const float thumb = 1.0F / (1.0F + std::exp((thumb_distance - others) / kThumbSoftnessMm));
    add_finger(kThumb, p, hand * thumb, w);
    float total = 0.0F;
    for (std::size_t f = kIndex; f < kSimFingerCount; ++f) {
        d[f] = std::exp((nearest - d[f]) / kNeighbourSoftnessMm);
        total += d[f];
    }
    for (std::size_t f = kIndex; f < kSimFingerCount; ++f) {
        add_finger(f, p, hand * (1.0F - thumb) * d[f] / total, w);
    }
    return w;
}

void keep_largest_four(const Weights& w, HandModel::Vertex& vertex) {
    std::array<std::uint8_t, kBoneCount> order{};
    for (std::size_t b = 0; b < kBoneCount; ++b) {
        order[b] = static_cast<std::uint8_t>(b);
    }
    std::partial_sort(order.begin(), order.begin() + 4, order.end(),
                      [&w](std::uint8_t a, std::uint8_t b) { return w[a] > w[b]; });
    float sum = 0.0F;
    for (std::size_t i = 0; i < 4; ++i) {
        vertex.bones[i] = order[i];
        vertex.weights[i] = w[order[i]];
        sum += w[order[i]];
    }
    for (float& weight : vertex.weights) {
        weight /= sum;
    }
}

float skin_texture(const Vec3f& p) {
    constexpr std::uint64_t kTextureSeed = 0x5EEDULL;
    constexpr float kCoarseMm = 14.0F;
    constexpr float kFineMm = 4.0F;
    return 1.0F + 0.05F * value_noise(p / kCoarseMm, kTextureSeed) +
           0.03F * value_noise(p / kFineMm, kTextureSeed + 1);
}

std::vector<float> arm_planes() {
    constexpr float kFineMm = 3.0F;
    constexpr float kCoarseMm = 12.0F;
    std::vector<float> ys = grid_planes(-620.0F, -66.0F, kCoarseMm);
    ys.pop_back();
    for (const float y : grid_planes(-66.0F, -30.0F, 2.0F * kFineMm)) {
        ys.push_back(y);
    }
    ys.pop_back();
    for (const float y : grid_planes(-30.0F, 194.0F, kFineMm)) {
        ys.push_back(y);
    }
    return ys;
}

HandModel build_hand_model() {
    constexpr float kStepMm = 3.0F;
    constexpr float kForearmPartBelowMm = -4.0F;
    constexpr float kSleeveBelowMm = -330.0F;
    const Mesh mesh = polygonise(skin_distance, grid_planes(-84.0F, 104.0F, kStepMm), arm_planes(),
                                 grid_planes(-66.0F, 66.0F, kStepMm));
    HandModel model;
    model.triangles = mesh.triangles;
    model.vertices.resize(mesh.positions_mm.size());
    for (std::size_t i = 0; i < model.vertices.size(); ++i) {
        HandModel::Vertex& v = model.vertices[i];
        v.position_mm = mesh.positions_mm[i];
        v.normal = mesh.normals[i];
        v.albedo = skin_texture(v.position_mm);
        const float y = v.position_mm.y();
        v.part = y > kForearmPartBelowMm ? SimPart::hand
                 : y > kSleeveBelowMm    ? SimPart::forearm
                                         : SimPart::body;
        keep_largest_four(skin_weights(v.position_mm), v);
    }
    for (std::size_t f = 0; f < kSimFingerCount; ++f) {
        const auto& joint = kFingerRest[f];
        const Vec3f axis = (joint[3] - joint[2]).normalized();
        const Vec3f pad =
            joint[2] + (joint[3] - joint[2]) * 0.8F + pad_direction(f, 2) * kFingerRadius[f][3];
        float furthest = -1.0F;
        float nearest = std::numeric_limits<float>::max();
        for (std::size_t i = 0; i < model.vertices.size(); ++i) {
            const HandModel::Vertex& v = model.vertices[i];
            if (v.bones[0] != finger_bone(f, 2)) {
                continue;
            }
            const float along = (v.position_mm - joint[2]).dot(axis);
            if (along > furthest) {
                furthest = along;
                model.tip_vertex[f] = static_cast<std::uint32_t>(i);
            }
            const float off = (v.position_mm - pad).norm();
            if (off < nearest) {
                nearest = off;
                model.pad_vertex[f] = static_cast<std::uint32_t>(i);
            }
        }
    }
    return model;
}

}  // namespace

const std::array<FingerRest, kSimFingerCount>& finger_rest() { return kFingerRest; }

const std::array<std::array<float, kBonesPerFinger + 1>, kSimFingerCount>& finger_radius() {
    return kFingerRadius;
}

Vec3f pad_direction(std::size_t finger, std::size_t segment_index) {
    const auto& joint = kFingerRest[finger];
    const Vec3f axis = (joint[segment_index + 1] - joint[segment_index]).normalized();
    const Vec3f wish = finger == kThumb ? kThumbPad : Vec3f(0.0F, 0.0F, 1.0F);
    return (wish - axis * wish.dot(axis)).normalized();
}

const HandModel& hand_model() {
    static const HandModel kModel = build_hand_model();
    return kModel;
}

}  // namespace xtrack::sim
