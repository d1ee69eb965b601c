// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/canvas.hpp"

#include <opencv2/imgproc.hpp>

namespace xtrack::tools {

namespace {

constexpr int kOversampling = 2;
constexpr int kFraction = 4;  // bits of a pixel that OpenCV draws with
constexpr double kTextSize = 0.41 * kOversampling;
constexpr double kBoldSize = 0.55 * kOversampling;

cv::Point at(double x, double y) {
    const double scale = kOversampling * (1 << kFraction);
    return {cvRound(x * scale), cvRound(y * scale)};
}

struct Letters {
    int font;
    double size;
    int thickness;
};

Letters letters(Canvas::Weight weight) {
    return weight == Canvas::Weight::bold ? Letters{cv::FONT_HERSHEY_DUPLEX, kBoldSize, 2}
                                          : Letters{cv::FONT_HERSHEY_SIMPLEX, kTextSize, 2};
}

}  // namespace

Canvas::Canvas(int width_px, int height_px)
    : image_(height_px * kOversampling, width_px * kOversampling, CV_8UC3, cv::Scalar::all(255)) {}

void Canvas::line(double x0, double y0, double x1, double y1, const cv::Scalar& colour) {
    cv::line(image_, at(x0, y0), at(x1, y1), colour, kOversampling, cv::LINE_AA, kFraction);
}

void Canvas::box(double left, double top, double right, double bottom, const cv::Scalar& colour,
                 Fill fill) {
    cv::rectangle(image_, at(left, top), at(right, bottom), colour,
                  fill == Fill::solid ? cv::FILLED : 2 * kOversampling, cv::LINE_AA, kFraction);
}

void Canvas::dot(double x, double y, double radius, const cv::Scalar& colour) {
    cv::circle(image_, at(x, y), at(radius, 0).x, colour, cv::FILLED, cv::LINE_AA, kFraction);
}

void Canvas::text(double x, double y, const std::string& text, const cv::Scalar& colour,
                  Weight weight) {
    const Letters l = letters(weight);
    cv::putText(image_, text, {cvRound(x * kOversampling), cvRound(y * kOversampling)}, l.font,
                l.size, colour, l.thickness, cv::LINE_AA);
}

double Canvas::text_width(const std::string& text, Weight weight) {
    const Letters l = letters(weight);
    int below = 0;
    return static_cast<double>(cv::getTextSize(text, l.font, l.size, l.thickness, &below).width) /
           kOversampling;
}

cv::Mat Canvas::finish() const {
    cv::Mat out;
    cv::resize(image_, out, {image_.cols / kOversampling, image_.rows / kOversampling}, 0, 0,
               cv::INTER_AREA);
    return out;
}

}  // namespace xtrack::tools
