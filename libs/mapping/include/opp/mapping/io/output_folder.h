// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace opp::mapping {

/// The folder a run writes into: either all results of a run are in it or none.
///
///     OutputFolder output("out", force);
///     ... write files into output.path() ...
///     output.commit();
///
/// Files are gathered in the subfolder `.unfinished` and move to the folder on commit(), run.json
/// last: a folder with run.json holds a finished run. Without commit() (an exception) the subfolder
/// goes, folders made by the constructor too, and what was there before stays as it was; but a
/// checkpoint stays, for a run that resumes. Other files in the folder are never touched. A killed
/// run leaves `.unfinished`; the next one clears it, or all but the checkpoint if it resumes.
class OutputFolder {
 public:
  /// Makes the folder if needed and claims it for this process.
  /// \param force replace the results of an earlier run. \param resume keep its checkpoint.
  /// \throws std::runtime_error if the folder holds results of a run and `force` is not set, if it
  /// is no folder or cannot be written, or if another run is writing into it. Results without
  /// run.json are none if there is a checkpoint to keep: that run was killed as they moved.
  OutputFolder(const std::filesystem::path& folder, bool force, bool resume = false);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where to write the files of this run.
  const std::filesystem::path& path() const { return unfinished_; }

  /// Where to keep what a run needs to resume; no result, it goes when all results are there.
  std::filesystem::path checkpoint() const;

  /// Moves the files of this run to the folder and removes those of an earlier run that this one
  /// did not make. To be called once, when all is written. \throws std::runtime_error if run.json
  /// was not written or a file cannot be moved.
  void commit();

 private:
  void claim();
  void clear(bool keep_checkpoint);

  std::filesystem::path folder_;
  std::filesystem::path existing_ancestor_;
  std::filesystem::path unfinished_;
  int lock_ = -1;
};

}  // namespace opp::mapping
