// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/core/keyframe.h"

#include <algorithm>
#include <cstddef>

namespace opp::mapping {

std::vector<double> timesOfPlane(const Keyframe& keyframe, int plane) {
  const std::vector<PlaneView>& views = keyframe.views.planes;
  const auto view = std::find_if(views.begin(), views.end(),
                                 [&](const PlaneView& v) { return v.keyframe_plane == plane; });
  std::vector<double> times;
  if (view == views.end() || view->is_own) times.push_back(keyframe.features.timestamp);
  if (view != views.end())
    times.insert(times.end(), view->timestamps.begin(), view->timestamps.end());
  return times;
}

std::vector<double> timesOfCorner(const Keyframe& keyframe, int corner) {
  const std::vector<CornerView>& views = keyframe.views.corners;
  const std::size_t own = keyframe.features.primitives_in_body.corners.size() -
                          (keyframe.views.adopted ? views.size() : 0);
  const auto index = static_cast<std::size_t>(corner);
  if (index < own) return {keyframe.features.timestamp};
  return views[index - own].timestamps;
}

}  // namespace opp::mapping
