#include "validation/harness/scenes/box_case.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "geometry/base/installation.hpp"
#include "meshing/dictionary/foam_command.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

std::string vector_text(const Vec3& v) {
    return fmt::format("({:.17g} {:.17g} {:.17g})", v.x(), v.y(), v.z());
}

std::string block_mesh(const BoxCase& box) {
    const Vec3& a = box.lower;
    const Vec3& b = box.upper;
    const char* top = box.sides == BoxSides::closed ? "wall" : "patch";
    const char* bottom = box.sides == BoxSides::duct ? "patch" : "wall";
    return fmt::format(
        "scale 1;\nvertices (({0} {1} {2}) ({3} {1} {2}) ({3} {4} {2}) ({0} {4} {2}) ({0} {1} {5}) ({3} {1} {5}) ({3} {4} {5}) ({0} {4} "
        "{5}));\n"
        "blocks ( hex (0 1 2 3 4 5 6 7) ({6} {7} {8}) simpleGrading (1 1 1) );\nedges ();\n"
        "boundary\n(\n    sides {{ type wall; faces ((0 4 7 3) (1 2 6 5) (0 1 5 4) (3 7 6 2)); }}\n"
        "    bottom {{ type {10}; faces ((0 3 2 1)); }}\n    top {{ type {9}; faces ((4 5 6 7)); }}\n);\nmergePatchPairs ();",
        a.x(), a.y(), a.z(), b.x(), b.y(), b.z(), box.cells[0], box.cells[1], box.cells[2], top, bottom);
}

/// The patches of the case: the box's, or those of another mesh.
std::string boundary(const BoxCase& box, const std::string& wall, const std::string& bottom, const std::string& top) {
    if (!box.mesh.empty())
        return fmt::format("#includeEtc \"caseDicts/setConstraintTypes\"\n    \".*\" {{ {} }}\n    rim {{ {} }}", wall, top);
    return fmt::format("sides {{ {} }}\n    bottom {{ {} }}\n    top {{ {} }}", wall, bottom, top);
}

void write_fields(const fs::path& folder, const BoxCase& box) {
    const std::string slip = "type slip;", balance = "type fixedFluxPressure; value uniform 0;";
    const bool open = box.sides != BoxSides::closed, duct = box.sides == BoxSides::duct;
    write_foam_dictionary(
        folder, "0/U", "volVectorField",
        fmt::format("dimensions [0 1 -1 0 0 0 0];\ninternalField uniform (0 0 {:.17g});\nboundaryField\n{{\n    {}\n}}", box.inflow,
                    boundary(box, slip, duct ? "type fixedValue; value $internalField;" : slip,
                             open ? "type pressureInletOutletVelocity; value uniform (0 0 0);" : slip)));
    write_foam_dictionary(folder, "0/p", "volScalarField",
                          fmt::format("dimensions [0 2 -2 0 0 0 0];\ninternalField uniform 0;\nboundaryField\n{{\n    {}\n}}",
                                      boundary(box, balance, balance, open ? "type fixedValue; value uniform 0;" : balance)));
}

void write_constant(const fs::path& folder, const BoxCase& box) {
    write_foam_dictionary(folder, "constant/g", "uniformDimensionedVectorField",
                          "dimensions [0 1 -2 0 0 0 0];\nvalue " + vector_text(box.gravity) + ";");
    write_foam_dictionary(folder, "constant/transportProperties", "dictionary",
                          fmt::format("transportModel Newtonian;\nnu {:.17g};\nrho {:.17g};", box.viscosity, box.density));
    write_foam_dictionary(folder, "constant/turbulenceProperties", "dictionary", "simulationType laminar;");
    write_foam_dictionary(folder, "constant/dynamicMeshDict", "dictionary",
                          box.motion.empty() ? "dynamicFvMesh staticFvMesh;" : box.motion);
    if (box.rocks.empty()) return;
    const std::string walls = std::string(box.rock_leaves_at_bottom ? "" : "zMin ") + (box.rock_leaves_at_top ? "" : "zMax");
    write_foam_dictionary(
        folder, "constant/couplingProperties", "dictionary",
        fmt::format("rock\n{{\n    feed \"constant/rockFeed.csv\";\n    contact {{ {} }}\n    walls ({});\n    shapes {{ {} }}\n"
                    "    domain {{ type box; lower {}; upper {}; walls ({}); }}\n}}\n"
                    "kernel {{ {} }}\nclosures {{ {} }}\n{}",
                    box.contact, box.walls, box.shapes, vector_text(box.lower), vector_text(box.upper), walls, box.kernel, box.closures,
                    box.extra));
    std::ofstream feed(folder / "constant/rockFeed.csv");
    feed << "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3,vx_m_s,vy_m_s,vz_m_s,shape\n";
    for (const BoxRock& rock : box.rocks)
        feed << fmt::format("{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{}\n", rock.id, rock.time,
                            rock.position.x(), rock.position.y(), rock.position.z(), rock.diameter, rock.density, rock.velocity.x(),
                            rock.velocity.y(), rock.velocity.z(), rock.shape);
    if (!feed) throw std::runtime_error("cannot write the rock feed");
}

void write_system(const fs::path& folder, const BoxCase& box) {
    write_foam_dictionary(folder, "system/blockMeshDict", "dictionary", box.mesh.empty() ? block_mesh(box) : box.mesh);
    write_foam_dictionary(
        folder, "system/controlDict", "dictionary",
        fmt::format("application cutterFoam;\nstartFrom latestTime;\nstartTime 0;\nstopAt endTime;\nendTime {:.17g};\ndeltaT {:.17g};\n"
                    "adjustTimeStep no;\nmaxCo 0.9;\nmaxDeltaT {:.17g};\nwriteControl adjustable;\nwriteInterval {:.17g};\n"
                    "writeFormat ascii;\nwritePrecision 17;\ntimePrecision 12;\nrunTimeModifiable no;\nfunctions\n{{\n{}\n}}",
                    box.end_time, box.time_step, box.time_step, std::min(box.write_interval, box.end_time), box.functions));
    write_foam_dictionary(
        folder, "system/fvSchemes", "dictionary",
        fmt::format("ddtSchemes {{ default Euler; }}\ngradSchemes {{ default Gauss linear; grad(U) cellLimited Gauss linear 1; "
                    "}}\ndivSchemes\n{{\n    default Gauss "
                    "upwind;\n    div(phi,U) Gauss {};\n    div((nuEff*dev2(T(grad(U))))) Gauss linear;\n"
                    "    div(((alpha*nuEff)*dev2(T(grad(U))))) Gauss linear;\n}}\nlaplacianSchemes {{ default Gauss linear "
                    "corrected; }}\ninterpolationSchemes {{ default linear; }}\nsnGradSchemes {{ default corrected; }}",
                    box.convection));
    write_foam_dictionary(
        folder, "system/fvSolution", "dictionary",
        fmt::format("solvers\n{{\n    \"p.*\" {{ {} tolerance {:g}; relTol 0; }}\n"
                    "    \"U.*\" {{ solver smoothSolver; smoother symGaussSeidel; tolerance 1e-12; relTol 0; }}\n}}\n"
                    "PIMPLE {{ nOuterCorrectors 1; nCorrectors 2; nNonOrthogonalCorrectors 0; pRefCell 0; pRefValue 0; }}",
                    box.pressure_solver, box.pressure_tolerance));
}

}  // namespace

void write_foam_dictionary(const fs::path& case_folder, const std::string& name, const std::string& kind, const std::string& body) {
    const fs::path file = case_folder / name;
    fs::create_directories(file.parent_path());
    std::ofstream stream(file);
    stream << fmt::format("FoamFile\n{{\n    version 2.0;\n    format ascii;\n    class {};\n    object {};\n}}\n{}\n", kind,
                          file.filename().string(), body);
    if (!stream) throw std::runtime_error("cannot write " + file.string());
}

std::string cutter_foam() {
    return (installation().programs / "cutterFoam").string();
}

fs::path scratch_folder(const std::string& name) {
    const fs::path folder = installation().prefix / "scratch" / name;
    fs::remove_all(folder);
    fs::create_directories(folder.parent_path());
    return folder;
}

void run_in_case(const fs::path& folder, const std::vector<std::string>& arguments) {
    require_child(meshing::foam_command(folder, arguments.front(), {arguments.begin() + 1, arguments.end()}));
}

void write_box_case(const fs::path& folder, const BoxCase& box) {
    fs::create_directories(folder);
    if (!fs::is_empty(folder)) throw std::runtime_error(folder.string() + " is not empty");
    write_system(folder, box);
    write_constant(folder, box);
    write_fields(folder, box);
    run_in_case(folder, {"blockMesh"});
}

void decompose(const fs::path& folder, const std::array<int, 3>& parts) {
    write_foam_dictionary(
        folder, "system/decomposeParDict", "dictionary",
        fmt::format("numberOfSubdomains {};\nmethod hierarchical;\nhierarchicalCoeffs {{ n ({} {} {}); delta 0.001; order xyz; }}",
                    parts[0] * parts[1] * parts[2], parts[0], parts[1], parts[2]));
    run_in_case(folder, {"decomposePar"});
}

void run_cutter_foam(const fs::path& folder, int ranks) {
    if (ranks > 1 && !fs::exists(folder / "processor0")) decompose(folder, {1, 1, ranks});
    require_child(meshing::foam_command(folder, cutter_foam(), {}, ranks));
}

std::map<std::string, std::vector<double>> read_columns(const fs::path& file) {
    std::ifstream stream(file);
    std::string line;
    if (!std::getline(stream, line)) throw std::runtime_error("cannot read " + file.string());
    const auto split = [](const std::string& text) {
        std::vector<std::string> fields;
        std::istringstream fields_stream(text);
        for (std::string field; std::getline(fields_stream, field, ',');) fields.push_back(field);
        return fields;
    };
    const std::vector<std::string> names = split(line);
    std::map<std::string, std::vector<double>> columns;
    while (std::getline(stream, line)) {
        std::vector<std::string> fields = split(line);
        fields.resize(names.size());
        for (std::size_t i = 0; i < names.size(); ++i) {
            char* end = nullptr;
            const double value = std::strtod(fields[i].c_str(), &end);
            columns[names[i]].push_back(end == fields[i].c_str() ? std::numeric_limits<double>::quiet_NaN() : value);
        }
    }
    return columns;
}

namespace {

/// Numbers of an ascii data array of a .vtp file.
template <class Number>
std::vector<Number> read_numbers(const std::string& text, const std::string& name) {
    std::size_t start = text.find("Name=\"" + name + "\"");
    if (start == std::string::npos) throw std::runtime_error("no array " + name + " in the picture");
    start = text.find('>', start) + 1;
    std::istringstream numbers(text.substr(start, text.find('<', start) - start));
    return {std::istream_iterator<Number>(numbers), {}};
}

std::vector<Vec3> read_vectors(const std::string& text, const std::string& name) {
    const std::vector<double> numbers = read_numbers<double>(text, name);
    std::vector<Vec3> vectors;
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) vectors.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    return vectors;
}

}  // namespace

std::vector<RockSnapshot> all_rocks(const fs::path& folder) {
    std::vector<RockSnapshot> pictures;
    for (const auto& entry : fs::directory_iterator(folder / "postProcessing/rock/vtk")) {
        std::ifstream stream(entry.path());
        const std::string text((std::istreambuf_iterator<char>(stream)), {});
        const std::string stem = entry.path().stem().string();
        pictures.push_back({std::stod(stem.substr(stem.find('_') + 1)), read_vectors(text, "Points"), read_vectors(text, "velocity"),
                            read_vectors(text, "hydrodynamic_force"), read_numbers<int>(text, "id"), read_numbers<double>(text, "diameter"),
                            read_numbers<double>(text, "density")});
    }
    if (pictures.empty()) throw std::runtime_error("no picture of rock in " + folder.string());
    std::sort(pictures.begin(), pictures.end(), [](const RockSnapshot& a, const RockSnapshot& b) { return a.time < b.time; });
    return pictures;
}

RockSnapshot last_rocks(const fs::path& folder) {
    return all_rocks(folder).back();
}

std::vector<std::vector<double>> read_function_object(const fs::path& folder, const std::string& name) {
    std::map<double, fs::path> starts;
    for (const auto& entry : fs::directory_iterator(folder / "postProcessing" / name))
        starts[std::stod(entry.path().filename())] = fs::directory_iterator(entry.path())->path();
    std::vector<std::vector<double>> rows;
    for (const auto& [start, file] : starts) {
        std::ifstream stream(file);
        for (std::string line; std::getline(stream, line);) {
            if (line.empty() || line[0] == '#') continue;
            std::istringstream fields(line);
            rows.emplace_back();
            for (std::string field; fields >> field;) {
                char* end = nullptr;
                const double value = std::strtod(field.c_str(), &end);
                if (end != field.c_str() && *end == '\0') rows.back().push_back(value);
            }
        }
    }
    return rows;
}

namespace {

/// The numbers of an ascii field's internalField, `components` a cell.
std::vector<double> read_field(const fs::path& file, std::size_t cells, std::size_t components) {
    std::ifstream stream(file);
    std::string text((std::istreambuf_iterator<char>(stream)), {});
    const std::size_t start = text.find("internalField");
    if (start == std::string::npos) throw std::runtime_error("no internalField in " + file.string());
    const std::size_t end = text.find("boundaryField", start);
    const bool uniform = text.compare(text.find_first_not_of(' ', start + std::string("internalField").size()), 7, "uniform") == 0;
    const std::size_t list = uniform ? text.find("uniform", start) + 7 : text.find('(', start) + 1;
    std::string numbers = text.substr(list, end - list);
    std::replace_if(
        numbers.begin(), numbers.end(), [](char c) { return c == '(' || c == ')' || c == ';'; }, ' ');
    std::istringstream values(numbers);
    std::vector<double> field;
    for (double value; values >> value;) field.push_back(value);
    if (uniform)
        for (std::size_t i = components; i < cells * components; ++i) field.push_back(field[i - components]);
    if (field.size() != cells * components) throw std::runtime_error("unexpected field in " + file.string());
    return field;
}

}  // namespace

std::vector<double> read_scalar_field(const fs::path& file, std::size_t cells) {
    return read_field(file, cells, 1);
}

std::vector<Vec3> read_vector_field(const fs::path& file, std::size_t cells) {
    const std::vector<double> numbers = read_field(file, cells, 3);
    std::vector<Vec3> field;
    for (std::size_t i = 0; i < cells; ++i) field.emplace_back(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
    return field;
}

}  // namespace cutterflow::validation
