#pragma once
/// \file Whole files: read, written atomically, and identified by their content.
#include <filesystem>
#include <fstream>
#include <string>

#include "geometry/base/error.hpp"

namespace cutterflow {

/// The file's bytes. \throws UserError  when it cannot be read
std::string read_file(const std::filesystem::path& file);

/// A file cannot be written: no permission, or no space. It may strike one process of several.
class NotWritten final : public UserError {
public:
    /// \param why  of the operating system; empty: not known
    explicit NotWritten(const std::filesystem::path& file, const std::string& why = "");
};

/// \throws NotWritten  when a stream failed to write its file
void require_written(const std::ofstream& stream, const std::filesystem::path& file);
/// Closes the stream of a file that is complete. \throws NotWritten  when not all of it was written
void close_written(std::ofstream& stream, const std::filesystem::path& file);

/// Writes a file under a temporary name beside it and renames it into place: a reader, or a run that is killed, finds the old content or
/// the new one. Makes the folder. \throws NotWritten
void write_file(const std::filesystem::path& file, const std::string& content);

/// SHA-256 of a text, and of a file's bytes, as 64 hexadecimal digits. \throws UserError  when the file cannot be read
std::string sha256(const std::string& text);
std::string sha256_of_file(const std::filesystem::path& file);

/// Whether a text is written as a SHA-256.
bool is_sha256(const std::string& text);

}  // namespace cutterflow
