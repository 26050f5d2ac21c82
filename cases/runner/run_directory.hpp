#pragma once
/// \file A run directory: who may use it, and what of it is the user's.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cutterflow::cases {

/// \throws UserError  when the path holds characters that OpenFOAM cannot take (spaces, quotes, brackets ...)
void require_openfoam_path(const std::filesystem::path& path);

/// Whether a folder is empty, holds nothing but overrides/, or is a run directory already.
/// \pre it is a folder
bool may_hold_a_run(const std::filesystem::path& path);

/// \throws UserError  as require_openfoam_path, or when a folder that is there holds something that is no run: nothing is overwritten
void require_usable_run_directory(const std::filesystem::path& path);

/// \throws UserError  when `folder`, whose frozen-rotor flow or bed shall be reused, is no run directory; a point of a sweep whose run has
/// not begun is an empty one
void require_start_donor(const std::filesystem::path& folder);

/// Whether there is a folder with anything in it but the lock, or something that is no folder.
bool holds_files(const std::filesystem::path& folder);

/// One process at a time works in a folder, and its children.
class FolderLock {
public:
    /// \throws UserError  when the folder cannot be written to, or another process uses it, which is named
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    int lock_;
};

/// A run directory that belongs to this process while the object lives. Children inherit the lock: a solver that outlives its parent
/// keeps the directory busy.
class RunDirectory {
public:
    /// Makes the folder when there is none.
    /// \throws UserError  when the path holds characters that OpenFOAM cannot take (spaces, quotes, brackets ...), the folder holds
    /// something
    ///                    that is no run (nothing is overwritten), or another process uses it
    explicit RunDirectory(const std::filesystem::path& path);

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path file(const std::string& relative) const { return path_ / relative; }

    /// Files below overrides/, relative to it, sorted.
    std::vector<std::string> overrides() const;

    /// Copies files of overrides/ (relative to it) over the run directory. \return the same
    std::vector<std::string> apply_overrides(std::vector<std::string> files) const;

private:
    std::filesystem::path path_;
    std::optional<FolderLock> lock_;
};

/// Removes the output of a run that was stopped before its first checkpoint: it cannot be resumed. Folders that a run does not
/// write are the user's and stay. What its starts took is noted (note_replaced_start).
void remove_unfinished_run(const std::filesystem::path& directory);

/// Regular files below a folder of the run directory, relative to `root`, sorted; empty when there is no such folder.
std::vector<std::string> files_below(const std::filesystem::path& root, const std::string& folder);

}  // namespace cutterflow::cases
