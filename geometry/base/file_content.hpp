#pragma once
/// \file Whole files: read, written atomically, and identified by their content.
#include <filesystem>
#include <string>

namespace cutterflow {

/// The file's bytes. \throws UserError  when it cannot be read
std::string read_file(const std::filesystem::path& file);

/// Writes a file under a temporary name beside it and renames it into place: a reader, or a run that is killed, finds the old content or
/// the new one. Makes the folder. \throws UserError  when it cannot be written
void write_file(const std::filesystem::path& file, const std::string& content);

/// SHA-256 of a text, and of a file's bytes, as 64 hexadecimal digits. \throws UserError  when the file cannot be read
std::string sha256(const std::string& text);
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace cutterflow
