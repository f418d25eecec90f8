// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/export/simplemap.h"

#include "opp/mapping/io/atomic_file.h"
#include "opp/mapping/io/mrpt_convert.h"

#include "export/embed_observation.h"
#include "io/rawlog_stream.h"
#include "io/scan_selection.h"

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include <exception>
#include <stdexcept>
#include <string>

namespace opp::mapping {
namespace {

/// A simplemap that is read from the rawlog while it is written; MRPT's own holds all observations
/// in memory. To readers it is an ordinary CSimpleMap.
class StreamedSimpleMap : public mrpt::maps::CSimpleMap {
 public:
  StreamedSimpleMap(const std::vector<SimplemapSource>& sources, const RawlogOptions& selection)
      : sources_(sources), selection_(selection) {}

  /// As the archive's operator, but errors come as they were thrown: MRPT wraps them.
  void writeTo(mrpt::serialization::CArchive& archive) const {
    try {
      archive << *this;
    } catch (const std::exception&) {
      if (failure_) std::rethrow_exception(failure_);
      throw;
    }
  }

 protected:
  void serializeTo(mrpt::serialization::CArchive& out) const override {
    try {
      std::size_t count = 0;
      for (const SimplemapSource& source : sources_) count += source.keyframes.size();
      out.WriteAs<uint32_t>(count);
      for (const SimplemapSource& source : sources_) writeKeyframes(source, out);
    } catch (...) {
      failure_ = std::current_exception();
      throw;
    }
  }

 private:
  void writeKeyframes(const SimplemapSource& source, mrpt::serialization::CArchive& out) const {
    const auto& [rawlog, keyframes] = source;
    RawlogStream stream(rawlog);
    ScanSelection selection(selection_);
    ObservationConverter converter(selection_.images_directory.empty()
                                       ? imagesDirectoryOf(rawlog)
                                       : selection_.images_directory);
    RawlogCounts counts;
    std::size_t written = 0;
    while (written < keyframes.size()) {
      const std::optional<RawlogItem> item = stream.next();
      if (!item) break;
      if (!item->observation || !ObservationConverter::isScan(*item->observation)) continue;
      const std::optional<std::size_t> index = selection.take(*item->observation, counts);
      const auto pose = index ? keyframes.find(*index) : keyframes.end();
      if (pose == keyframes.end()) continue;
      embed(*item->observation, converter);
      write(pose->second, item->observation, out);
      ++written;
    }
    if (written < keyframes.size()) {
      throw std::runtime_error(rawlog.string() + " lacks " +
                               std::to_string(keyframes.size() - written) +
                               " of the keyframes; was it changed since it was mapped?");
    }
  }

  static void write(const Eigen::Isometry3d& map_from_body,
                    const mrpt::obs::CObservation::Ptr& observation,
                    mrpt::serialization::CArchive& out) {
    mrpt::poses::CPose3DPDFGaussian pose(toCPose3D(map_from_body));
    mrpt::obs::CSensoryFrame frame;
    frame.insert(observation);
    out << pose << frame;
  }

  const std::vector<SimplemapSource>& sources_;
  const RawlogOptions& selection_;
  mutable std::exception_ptr failure_;
};

}  // namespace

void writeSimplemap(const std::filesystem::path& path, const std::vector<SimplemapSource>& sources,
                    const RawlogOptions& selection) {
  replaceFileAtomically(path, [&](const std::filesystem::path& temporary) {
    mrpt::io::CFileGZOutputStream stream;
    if (!stream.open(temporary.string(), 1)) {
      throw std::runtime_error(path.string() + " cannot be written; check folder and rights");
    }
    auto archive = mrpt::serialization::archiveFrom(stream);
    StreamedSimpleMap(sources, selection).writeTo(archive);
    stream.close();
  });
}

}  // namespace opp::mapping
