// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <opencv2/core.hpp>

namespace xtrack::tools {

/// A white picture for diagrams: lines and letters are drawn at twice the size and made smaller at
/// the end, as OpenCV's thin letters are hard to read otherwise.
class Canvas {
 public:
    Canvas(int width_px, int height_px);

    enum class Weight { normal, bold };
    enum class Fill { solid, hollow };

    void line(double x0, double y0, double x1, double y1, const cv::Scalar& colour);
    void box(double left, double top, double right, double bottom, const cv::Scalar& colour,
             Fill fill);
    void dot(double x, double y, double radius, const cv::Scalar& colour);
    /// @param y of the line that letters stand on
    void text(double x, double y, const std::string& text, const cv::Scalar& colour,
              Weight weight = Weight::normal);
    [[nodiscard]] static double text_width(const std::string& text, Weight weight = Weight::normal);

    [[nodiscard]] cv::Mat finish() const;

 private:
    cv::Mat image_;
};

}  // namespace xtrack::tools
