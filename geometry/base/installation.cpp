#include "geometry/base/installation.hpp"

#include <fmt/format.h>

#include "geometry/base/error.hpp"

namespace cutterflow {

namespace fs = std::filesystem;

Installation installation_of(const fs::path& program) {
    const fs::path data = "share/cutterflow";
    fs::path prefix = program.parent_path();
    while (!fs::exists(prefix / data / "docs/references.bib")) {
        if (prefix == prefix.parent_path())
            throw UserError(fmt::format("{} has no share/cutterflow in any folder above it", program.string()),
                            "A program of Cutterflow reads the files that are installed with it",
                            "Run it where it was built or installed (cmake --install build --prefix FOLDER)");
        prefix = prefix.parent_path();
    }
    return {prefix, prefix / "bin", prefix / "libexec/cutterflow/verification", prefix / data};
}

Installation installation() {
    return installation_of(fs::read_symlink("/proc/self/exe"));
}

}  // namespace cutterflow
