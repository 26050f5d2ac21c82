#include "cases/scenes/rock/shapes_section.hpp"

#include "cases/study/shape_file.hpp"

namespace cutterflow::cases {

meshing::FoamDictionary shapes_section(const std::vector<std::string>& names) {
    meshing::FoamDictionary section;
    for (const std::string& name : names)
        section.add(name, meshing::FoamDictionary().add("file", meshing::FoamValue::quoted(path_of_shape(name))));
    return section;
}

}  // namespace cutterflow::cases
