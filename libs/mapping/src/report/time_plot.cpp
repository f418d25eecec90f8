// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/report/time_plot.h"

#include "export/drawing_numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace opp::mapping {
namespace {

constexpr double kWidth = 960.0, kHeight = 150.0;      ///< of the picture, in its units
constexpr double kLeft = 48.0, kRight = 12.0;          ///< margins: numbers to the left,
constexpr double kTop = 8.0, kBottom = 22.0;           ///< times below
constexpr double kTicksAcross = 12.0, kTicksUp = 4.0;  ///< at least; at most 2.5 times as many
constexpr double kLeastSpan = 0.1;  ///< [m] else a body at rest would show as wild noise
constexpr double kShortest = 1e-3;  ///< [s] less is no axis
constexpr double kColumn = 0.5;     ///< values of so many units across are drawn as one stroke

struct Range {
  double low, high;
  double span() const { return high - low; }
};

Range rangeOfTimes(const std::vector<double>& times) {
  if (times.empty()) return {0.0, 1.0};
  const Range range{times.front(), times.back()};
  if (range.span() >= kShortest) return range;
  return {range.low - 0.5, range.high + 0.5};
}

Range rangeOfValues(const std::vector<double>& values) {
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    range = {std::min(range.low, value), std::max(range.high, value)};
  }
  if (!(range.low <= range.high)) return {0.0, 1.0};
  const double margin = 0.5 * std::max(0.1 * range.span(), kLeastSpan - range.span());
  return {range.low - margin, range.high + margin};
}

int decimalsOf(double step) {
  return std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
}

class Plot {
 public:
  Plot(const std::vector<double>& times, const std::vector<double>& values)
      : times_(times), values_(values), across_(rangeOfTimes(times)), up_(rangeOfValues(values)) {}

  std::string svg(std::string_view name) {
    drawGaps();
    drawGrid();
    drawLine();
    return "<svg class=\"plot\" viewBox=\"0 0 " + svgNumber(kWidth) + ' ' + svgNumber(kHeight) +
           "\">\n" + body_ + "<text class=\"name\" x=\"" + svgNumber(kLeft + 6.0) + "\" y=\"" +
           svgNumber(kTop + 14.0) + "\">" + std::string(name) + "</text>\n</svg>\n";
  }

 private:
  double x(double time) const {
    return kLeft + (time - across_.low) / across_.span() * (kWidth - kLeft - kRight);
  }
  double y(double value) const {
    return kTop + (up_.high - value) / up_.span() * (kHeight - kTop - kBottom);
  }
  bool isKnown(std::size_t i) const { return std::isfinite(values_[i]); }

  /// The end of the stretch of times with values, or without, that begins at `begin`.
  std::size_t endOfStretch(std::size_t begin) const {
    std::size_t end = begin + 1;
    while (end < times_.size() && isKnown(end) == isKnown(begin)) ++end;
    return end;
  }

  void drawGaps() {
    for (std::size_t begin = 0, end = 0; begin < times_.size(); begin = end) {
      end = endOfStretch(begin);
      if (isKnown(begin)) continue;
      const double from = begin > 0 ? times_[begin - 1] : across_.low;
      const double to = end < times_.size() ? times_[end] : across_.high;
      body_ += "<rect class=\"gap\" x=\"" + svgNumber(x(from)) + "\" y=\"" + svgNumber(kTop) +
               "\" width=\"" + svgNumber(std::max(1.0, x(to) - x(from))) + "\" height=\"" +
               svgNumber(kHeight - kTop - kBottom) + "\"/>\n";
    }
  }

  void drawGrid() {
    std::string path, labels;
    const double bottom = kHeight - kBottom, right = kWidth - kRight;
    const auto label = [&labels](double at_x, double at_y, const char* anchor, std::string text) {
      labels += "<text x=\"" + svgNumber(at_x) + "\" y=\"" + svgNumber(at_y) + "\" text-anchor=\"" +
                anchor + "\">" + std::move(text) + "</text>\n";
    };
    const double step_up = roundStep(up_.span() / kTicksUp);
    for (double k = std::ceil(up_.low / step_up); k * step_up <= up_.high; ++k) {
      const double at = y(k * step_up);
      path += 'M' + svgNumber(kLeft) + ' ' + svgNumber(at) + 'H' + svgNumber(right);
      label(kLeft - 6.0, at + 4.0, "end", fixedNumber(k * step_up, decimalsOf(step_up)));
    }
    const double step = roundStep(across_.span() / kTicksAcross);
    for (double k = std::ceil(across_.low / step); k * step <= across_.high; ++k) {
      const double at = x(k * step);
      path += 'M' + svgNumber(at) + ' ' + svgNumber(bottom) + "v4";
      label(at, bottom + 16.0, "middle", fixedNumber(k * step, decimalsOf(step)) + " s");
    }
    body_ += "<path class=\"grid\" d=\"" + path + "\"/>\n" + labels;
  }

  void drawLine() {
    std::string path;
    for (std::size_t begin = 0, end = 0; begin < times_.size(); begin = end) {
      end = endOfStretch(begin);
      if (isKnown(begin)) addStretch(begin, end, path);
    }
    if (!path.empty()) body_ += "<path class=\"line\" d=\"" + path + "\"/>\n";
  }

  void addStretch(std::size_t begin, std::size_t end, std::string& path) const {
    std::size_t last = end;
    const auto add = [&](std::size_t i) {
      if (i == last) return;
      path += (i == begin ? 'M' : 'L') + svgNumber(x(times_[i])) + ' ' + svgNumber(y(values_[i]));
      last = i;
    };
    for (std::size_t first = begin, next = begin; first < end; first = next) {
      const double column = std::floor(x(times_[first]) / kColumn);
      while (next < end && std::floor(x(times_[next]) / kColumn) <= column) ++next;
      addColumn(first, next, add);
    }
    if (end - begin == 1) path += "h0";  // a dot
  }

  /// Of the values in one column of the picture, the first, the extremes and the last: the rest
  /// would be drawn over them.
  template <typename Add>
  void addColumn(std::size_t first, std::size_t next, const Add& add) const {
    const auto at = values_.begin();
    const auto [low, high] = std::minmax_element(at + static_cast<std::ptrdiff_t>(first),
                                                 at + static_cast<std::ptrdiff_t>(next));
    std::array<std::size_t, 4> chosen = {first, static_cast<std::size_t>(low - at),
                                         static_cast<std::size_t>(high - at), next - 1};
    std::sort(chosen.begin(), chosen.end());
    for (const std::size_t i : chosen) add(i);
  }

  const std::vector<double>& times_;
  const std::vector<double>& values_;
  Range across_, up_;
  std::string body_;
};

}  // namespace

std::string timePlotSvg(std::string_view name, const std::vector<double>& times,
                        const std::vector<double>& values) {
  if (times.size() != values.size()) {
    throw std::invalid_argument("a plot needs one value for each time");
  }
  return Plot(times, values).svg(name);
}

}  // namespace opp::mapping
