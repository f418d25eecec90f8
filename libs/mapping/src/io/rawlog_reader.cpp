// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/rawlog_reader.h"

#include "opp/mapping/io/mrpt_convert.h"

#include "io/observation_to_cloud.h"
#include "io/odometry_accumulator.h"
#include "io/rawlog_stream.h"
#include "io/scan_selection.h"

#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <sstream>
#include <stdexcept>

namespace opp::mapping {
namespace {

std::string listOf(const std::map<std::string, std::size_t>& counts) {
  std::ostringstream text;
  for (const auto& [name, count] : counts) {
    text << (text.tellp() > 0 ? ", " : "") << count << " x '" << name << "'";
  }
  return text.str();
}

}  // namespace

struct RawlogReader::Impl {
  Impl(const std::filesystem::path& rawlog, RawlogOptions wanted)
      : file(rawlog),
        options(std::move(wanted)),
        selection(options),
        stream(rawlog),
        converter(options.images_directory.empty() ? imagesDirectoryOf(rawlog)
                                                   : options.images_directory) {}

  std::optional<RawlogEntry> read(const RawlogItem& item);
  std::optional<RawlogEntry> readObservation(mrpt::obs::CObservation& observation);
  std::optional<RawlogEntry> readScan(mrpt::obs::CObservation& observation);
  std::string whyNothing() const;

  std::filesystem::path file;
  RawlogOptions options;
  ScanSelection selection;
  RawlogStream stream;
  ObservationConverter converter;
  OdometryAccumulator odometry;
  std::optional<RawlogEntry> after_odometry;  ///< what the action just delivered led to
  RawlogCounts counts;
};

std::optional<RawlogEntry> RawlogReader::Impl::read(const RawlogItem& item) {
  if (item.action) {
    odometry.add(*item.action);
    return std::nullopt;
  }
  auto& observation = *item.observation;
  if (dynamic_cast<const mrpt::obs::CObservationComment*>(&observation)) return std::nullopt;
  std::optional<OdometryReading> moved = odometry.takePending(toSeconds(observation.timestamp));
  std::optional<RawlogEntry> entry = readObservation(observation);
  if (!moved) return entry;
  after_odometry = std::move(entry);
  return RawlogEntry(*moved);
}

std::optional<RawlogEntry> RawlogReader::Impl::readObservation(
    mrpt::obs::CObservation& observation) {
  if (const auto* absolute = dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation)) {
    return RawlogEntry(odometry.reading(*absolute));
  }
  if (ObservationConverter::isScan(observation)) return readScan(observation);
  ++counts.skipped[observation.GetRuntimeClass()->className];
  return std::nullopt;
}

std::optional<RawlogEntry> RawlogReader::Impl::readScan(mrpt::obs::CObservation& observation) {
  const std::optional<std::size_t> index = selection.take(observation, counts);
  if (!index) return std::nullopt;
  Scan scan;
  scan.timestamp = toSeconds(observation.timestamp);
  scan.sensor_label = observation.sensorLabel;
  scan.index = *index;
  try {
    scan.cloud_in_body = converter.convert(observation);
  } catch (const std::exception& error) {
    ++counts.skipped[error.what()];
    return std::nullopt;
  }
  return RawlogEntry(std::move(scan));
}

std::string RawlogReader::Impl::whyNothing() const {
  const std::string name = file.string();
  if (!stream.damage().empty()) return stream.damage() + "; no 3D observation was among it";
  if (counts.objects == 0) return name + " is empty; record or fetch the rawlog again";
  if (counts.deselected > 0) {
    return name + " has no 3D observation in the chosen range and label; it holds " +
           listOf(counts.labels) +
           " (sensor labels), change --from-index, --to-index or "
           "--sensor-label";
  }
  return name + " holds no usable 3D observation" +
         (counts.skipped.empty() ? "" : " but " + listOf(counts.skipped)) +
         "; opp needs CObservation3DRangeScan, CObservationPointCloud, CObservationVelodyneScan or "
         "CObservationRotatingScan";
}

RawlogReader::RawlogReader(const std::filesystem::path& file, RawlogOptions options) {
  impl_ = std::make_unique<Impl>(file, std::move(options));
}

RawlogReader::~RawlogReader() = default;
RawlogReader::RawlogReader(RawlogReader&&) noexcept = default;
RawlogReader& RawlogReader::operator=(RawlogReader&&) noexcept = default;

std::optional<RawlogEntry> RawlogReader::next() {
  std::optional<RawlogEntry> entry;
  std::swap(entry, impl_->after_odometry);
  while (!entry) {
    const std::optional<RawlogItem> item = impl_->stream.next();
    impl_->counts.objects = impl_->stream.objects();
    if (!item) {
      impl_->counts.skipped.insert(impl_->stream.foreign().begin(), impl_->stream.foreign().end());
      break;
    }
    entry = impl_->read(*item);
  }
  if (entry) {
    ++(std::holds_alternative<Scan>(*entry) ? impl_->counts.scans : impl_->counts.odometry);
  } else if (impl_->counts.scans == 0) {
    throw std::runtime_error(impl_->whyNothing());
  }
  return entry;
}

std::optional<Scan> RawlogReader::nextScan() {
  while (std::optional<RawlogEntry> entry = next()) {
    if (auto* scan = std::get_if<Scan>(&*entry)) return std::move(*scan);
  }
  return std::nullopt;
}

double RawlogReader::progress() const { return impl_->stream.progress(); }
const RawlogCounts& RawlogReader::counts() const { return impl_->counts; }
const std::string& RawlogReader::damage() const { return impl_->stream.damage(); }

std::filesystem::path imagesDirectoryOf(const std::filesystem::path& rawlog) {
  const std::filesystem::path folder = rawlog.parent_path();
  const std::string stem = rawlog.stem().string();
  for (const std::string& name :
       {stem + "_Images", stem + "_images", stem + "_IMAGES", std::string("Images")}) {
    if (std::filesystem::is_directory(folder / name)) return folder / name;
  }
  return folder.empty() ? std::filesystem::path(".") : folder;
}

}  // namespace opp::mapping
