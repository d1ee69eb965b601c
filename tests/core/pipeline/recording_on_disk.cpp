// SPDX-License-Identifier: Apache-2.0
#include "tests/core/pipeline/recording_on_disk.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace xtrack::test {
namespace {

namespace fs = std::filesystem;

template <typename Target>
void read_matrix(const cv::FileStorage& file, const char* name, Target& target) {
    cv::Mat matrix;
    file[name] >> matrix;
    for (int i = 0; i < matrix.rows; ++i) {
        for (int j = 0; j < matrix.cols; ++j) {
            target(i, j) = matrix.at<double>(i, j);
        }
    }
}

Pinhole read_lens(const cv::FileStorage& file, const std::string& name) {
    Pinhole lens;
    read_matrix(file, (name + "_matrix").c_str(), lens.matrix);
    cv::Mat distortion;
    file[name + "_distortion"] >> distortion;
    for (int i = 0; i < static_cast<int>(distortion.total()) && i < 8; ++i) {
        lens.distortion[static_cast<std::size_t>(i)] = distortion.at<double>(i);
    }
    lens.size = {static_cast<int>(file[name + "_size"][0]),
                 static_cast<int>(file[name + "_size"][1])};
    return lens;
}

Pattern read_pattern(const cv::FileNode& node) {
    Pattern pattern;
    const std::string kind = node["kind"];
    if (kind == "sine") {
        pattern.kind = PatternKind::sine;
        pattern.period_px = node["period_px"];
        pattern.phase_rad[0] = node["phase_rad"];
    } else if (kind == "rgb_sine") {
        pattern.kind = PatternKind::rgb_sine;
        pattern.period_px = node["period_px"];
        for (std::size_t k = 0; k < pattern.phase_rad.size(); ++k) {
            pattern.phase_rad[k] = node["phase_rad"][static_cast<int>(k)];
        }
    } else if (kind == "gray_code") {
        pattern.kind = PatternKind::gray_code;
        pattern.bit = node["bit"];
        pattern.bits = node["bits"];
        pattern.cell_px = node["cell_px"];
        pattern.offset_px = node["offset_px"];
        pattern.inverted = static_cast<int>(node["inverted"]) != 0;
    } else {
        pattern.level = node["level"];
    }
    return pattern;
}

template <typename T>
Image<T> to_image(const cv::Mat& mat) {
    Image<T> image(mat.cols * mat.channels(), mat.rows);
    for (int y = 0; y < mat.rows; ++y) {
        std::copy_n(mat.ptr<T>(y), image.width(), image.row(y));
    }
    return image;
}

fs::path truth_file(const RecordingOnDisk& recording, const char* kind, int index) {
    char name[32];
    std::snprintf(name, sizeof(name), "%06d.png", index);
    return recording.folder / "truth" / kind / name;
}

void read_rig(RecordingOnDisk& recording) {
    const cv::FileStorage rig((recording.folder / "rig.yaml").string(), cv::FileStorage::READ);
    recording.rig.camera = read_lens(rig, "camera");
    recording.rig.projector = read_lens(rig, "projector");
    read_matrix(rig, "projector_from_camera_R", recording.rig.projector_from_camera_R);
    read_matrix(rig, "projector_from_camera_T", recording.rig.projector_from_camera_T);
    if (!rig["camera_from_projector_rgb"].empty()) {
        Mat3d colours;
        read_matrix(rig, "camera_from_projector_rgb", colours);
        recording.rig.camera_from_projector_rgb = colours;
    }
    if (const cv::FileNode volume = rig["working_volume_mm"]; !volume.empty()) {
        recording.rig.working_volume =
            WorkingVolume{static_cast<double>(volume[0]), static_cast<double>(volume[1])};
    }
}

}  // namespace

Image<std::uint16_t> RecordingOnDisk::truth_depth(int index) const {
    return to_image<std::uint16_t>(
        cv::imread(truth_file(*this, "depth", index).string(), cv::IMREAD_UNCHANGED));
}

Image<std::uint8_t> RecordingOnDisk::truth_mask(int index) const {
    return to_image<std::uint8_t>(
        cv::imread(truth_file(*this, "mask", index).string(), cv::IMREAD_UNCHANGED));
}

bool load_recording(const std::string& name, RecordingOnDisk& recording) {
    recording.folder = fs::path(XTRACK_SHARED_DATA) / name;
    if (!fs::exists(recording.folder / "frames.csv")) {
        return false;
    }
    if (fs::exists(recording.folder / "rig.yaml")) {
        read_rig(recording);
    }
    const cv::FileStorage patterns((recording.folder / "pattern.yaml").string(),
                                   cv::FileStorage::READ);
    recording.patterns.axis = static_cast<std::string>(patterns["axis"]) == "y" ? Axis::y : Axis::x;
    recording.patterns.projector_size = {static_cast<int>(patterns["projector_size"][0]),
                                         static_cast<int>(patterns["projector_size"][1])};
    if (!patterns["gamma"].empty()) {
        recording.patterns.gamma = static_cast<double>(patterns["gamma"]);
    }
    for (const cv::FileNode& node : patterns["sequence"]) {
        recording.patterns.patterns.push_back(read_pattern(node));
    }
    std::ifstream list(recording.folder / "frames.csv");
    std::string line;
    std::getline(list, line);
    while (std::getline(list, line)) {
        std::istringstream fields(line);
        std::string file, stamp, sequence, pattern;
        std::getline(fields, file, ',');
        std::getline(fields, stamp, ',');
        std::getline(fields, sequence, ',');
        std::getline(fields, pattern, ',');
        const cv::Mat image = cv::imread((recording.folder / file).string(), cv::IMREAD_UNCHANGED);
        auto frame = std::make_shared<Frame>();
        frame->format = image.channels() == 3 ? PixelFormat::bgr8 : PixelFormat::grey8;
        frame->stamp = Stamp::from_us(std::stoll(stamp));
        frame->sequence = std::stoull(sequence);
        frame->pattern = std::stoi(pattern);
        frame->clean_row_end = image.rows;
        frame->pixels = to_image<std::uint8_t>(image);
        recording.frames.push_back(frame);
    }
    return true;
}

}  // namespace xtrack::test
