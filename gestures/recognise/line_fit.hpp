// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <xtrack/geometry.hpp>

namespace xtrack::recognise {

/// Straight line through points over time, least squares.
class LineFit {
 public:
    explicit LineFit(const Vec3f& origin) : origin_(origin) {}
    void add(double t_s, const Vec3f& point) {
        const Vec3d p = (point - origin_).cast<double>();
        ++count_;
        sum_t_ += t_s;
        sum_tt_ += t_s * t_s;
        sum_p_ += p;
        sum_tp_ += t_s * p;
    }
    [[nodiscard]] int count() const { return count_; }
    /// A second; zero where there is one moment only.
    [[nodiscard]] Vec3f slope() const {
        const double spread = count_ * sum_tt_ - sum_t_ * sum_t_;
        return spread > 0.0 ? Vec3f(((count_ * sum_tp_ - sum_t_ * sum_p_) / spread).cast<float>())
                            : Vec3f(Vec3f::Zero());
    }

 private:
    Vec3f origin_;  // near the points, so that squares stay small
    int count_ = 0;
    double sum_t_ = 0.0;
    double sum_tt_ = 0.0;
    Vec3d sum_p_ = Vec3d::Zero();
    Vec3d sum_tp_ = Vec3d::Zero();
};

}  // namespace xtrack::recognise
