#include "geometry/base/file_content.hpp"

#include <fcntl.h>
#include <sha256.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

namespace cutterflow {
namespace {

std::ifstream open_for_reading(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream || std::filesystem::is_directory(file))
        throw UserError(fmt::format("cannot read {}", file.string()), "It must be a readable file", "Check the path and its permissions");
    return stream;
}

[[noreturn]] void throw_not_written(const std::filesystem::path& file, int error) {
    throw NotWritten(file, std::strerror(error));
}

void write_all(int descriptor, const std::string& content, const std::filesystem::path& file) {
    std::size_t written = 0;
    while (written < content.size()) {
        const ssize_t count = ::write(descriptor, content.data() + written, content.size() - written);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) throw_not_written(file, errno);
        written += static_cast<std::size_t>(count);
    }
}

std::string hexadecimal(SHA256_CTX& context) {
    std::array<std::uint8_t, SHA256_DIGEST_LENGTH> digest;
    SHA256_Final(digest.data(), &context);
    return fmt::format("{:02x}", fmt::join(digest, ""));
}

}  // namespace

NotWritten::NotWritten(const std::filesystem::path& file, const std::string& why)
    : UserError(fmt::format("cannot write {}{}{}", file.string(), why.empty() ? "" : ": ", why),
                "Its folder must be writable and have free space", "Check its permissions and the disk") {}

void require_written(const std::ofstream& stream, const std::filesystem::path& file) {
    if (!stream) throw NotWritten(file);
}

void close_written(std::ofstream& stream, const std::filesystem::path& file) {
    stream.close();
    require_written(stream, file);
}

std::string read_file(const std::filesystem::path& file) {
    std::ifstream stream = open_for_reading(file);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void write_file(const std::filesystem::path& file, const std::string& content) {
    std::error_code no_folder;
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), no_folder);
    if (no_folder) throw_not_written(file, no_folder.value());
    std::filesystem::path temporary = file;
    temporary += fmt::format(".part{}", ::getpid());
    const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor < 0) throw_not_written(file, errno);
    try {
        write_all(descriptor, content, file);
        if (::fsync(descriptor) != 0) throw_not_written(file, errno);
    } catch (...) {
        ::close(descriptor);
        ::unlink(temporary.c_str());
        throw;
    }
    ::close(descriptor);
    if (::rename(temporary.c_str(), file.c_str()) != 0) {
        const int error = errno;
        ::unlink(temporary.c_str());
        throw_not_written(file, error);
    }
}

std::string sha256(const std::string& text) {
    SHA256_CTX context;
    SHA256_Init(&context);
    SHA256_Update(&context, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    return hexadecimal(context);
}

std::string sha256_of_file(const std::filesystem::path& file) {
    std::ifstream stream = open_for_reading(file);
    SHA256_CTX context;
    SHA256_Init(&context);
    std::array<char, 65536> buffer;
    while (stream.read(buffer.data(), buffer.size()) || stream.gcount() > 0)
        SHA256_Update(&context, reinterpret_cast<const std::uint8_t*>(buffer.data()), static_cast<std::size_t>(stream.gcount()));
    return hexadecimal(context);
}

bool is_sha256(const std::string& text) {
    return text.size() == 2 * SHA256_DIGEST_LENGTH && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

}  // namespace cutterflow
