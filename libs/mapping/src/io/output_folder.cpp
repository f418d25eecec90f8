// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace opp::mapping {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFinishedMark = "run.json";
constexpr std::string_view kLockFile = ".lock";
constexpr std::string_view kCheckpoint = "checkpoint";

/// Every file that a run may leave in its folder (the contract's table for opp-map).
constexpr std::array<std::string_view, 14> kRunFiles = {
    "run.json",       "trajectory.tum", "map.bt",         "map.ot",        "planar_map.json",
    "planar_map.ply", "planar_map.obj", "planar_map.glb", "floorplan.svg", "scene.3Dscene",
    "map.simplemap",  "report.html",    "effective.ini",  "parts"};

[[noreturn]] void fail(const fs::path& folder, const std::string& reason) {
  throw std::runtime_error("output folder " + folder.string() + ": " + reason);
}

void refuseResults(const fs::path& folder) {
  for (const std::string_view name : kRunFiles) {
    if (!fs::exists(folder / name)) continue;
    fail(folder, (name == kFinishedMark ? "it holds a finished run" : "it holds files of a run") +
                     (" (" + std::string(name) + "); name another folder or add --force"));
  }
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& folder, bool force, bool resume)
    : folder_(fs::absolute(folder).lexically_normal()) {
  if (folder_.filename().empty()) folder_ = folder_.parent_path();  // "out/" is "out"
  existing_ancestor_ = folder_;
  while (!fs::exists(existing_ancestor_)) existing_ancestor_ = existing_ancestor_.parent_path();
  if (!fs::is_directory(existing_ancestor_)) {
    fail(folder_, existing_ancestor_.string() + " is not a folder");
  }
  unfinished_ = folder_ / ".unfinished";
  const bool goes_on = resume && fs::exists(checkpoint()) && !fs::exists(folder_ / kFinishedMark);
  if (!force && !goes_on) refuseResults(folder_);
  claim();
  clear(resume);
}

fs::path OutputFolder::checkpoint() const { return unfinished_ / kCheckpoint; }

void OutputFolder::claim() {
  std::error_code error;
  fs::create_directories(unfinished_, error);
  if (error) fail(folder_, "cannot create it: " + error.message());
  const fs::path lock_file = unfinished_ / kLockFile;
  lock_ = open(lock_file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock_ < 0) fail(folder_, "cannot write there");
  if (flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    close(std::exchange(lock_, -1));
    fail(folder_, "another run is writing into it");
  }
}

void OutputFolder::clear(bool keep_checkpoint) {
  for (const auto& entry : fs::directory_iterator(unfinished_)) {
    const fs::path name = entry.path().filename();
    if (name == kLockFile || (keep_checkpoint && name == kCheckpoint)) continue;
    fs::remove_all(entry.path());
  }
}

void OutputFolder::commit() {
  if (!fs::exists(unfinished_ / kFinishedMark)) {
    throw std::logic_error("a run must write run.json before it is committed");
  }
  std::vector<fs::path> names;
  for (const auto& entry : fs::directory_iterator(unfinished_)) {
    const fs::path name = entry.path().filename();
    if (name != kLockFile && name != kCheckpoint && name != kFinishedMark) names.push_back(name);
  }
  names.emplace_back(kFinishedMark);
  // The mark goes first and comes last: a folder with it never holds a mixture of two runs.
  for (const std::string_view name : kRunFiles) fs::remove_all(folder_ / name);
  for (const fs::path& name : names) {
    if (fs::is_directory(folder_ / name)) fs::remove_all(folder_ / name);
    fs::rename(unfinished_ / name, folder_ / name);
  }
  fs::remove(checkpoint());
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;  // no worse than a leftover folder, which the next run clears
  try {
    clear(true);
  } catch (const fs::filesystem_error&) {
  }
  fs::remove(unfinished_ / kLockFile, ignored);
  fs::remove(unfinished_, ignored);  // unless there is a checkpoint
  if (lock_ >= 0) close(lock_);
  // Undo what the constructor made; a folder that holds something is not removed.
  for (fs::path made = folder_; made != existing_ancestor_; made = made.parent_path()) {
    fs::remove(made, ignored);
  }
}

}  // namespace opp::mapping
