#include "solver/free_surface/output/surface_recorder.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ostream.h>

#include "geometry/base/file_content.hpp"

namespace cutterflow::free_surface {

namespace {

std::ofstream open_rows(const std::filesystem::path& file, const std::string& head) {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream stream(file);
    stream << head << '\n';
    require_written(stream, file);
    return stream;
}

/// A VTK data array as text.
template <typename Row>
std::string data_array(const std::string& name, int components, std::size_t count, const Row& row) {
    std::string text =
        fmt::format("<DataArray type=\"Float64\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">\n", name, components);
    for (std::size_t n = 0; n < count; ++n) {
        const auto values = row(n);
        for (const double value : values) text += fmt::format("{:.7g} ", value);
        text += '\n';
    }
    return text + "</DataArray>\n";
}

std::array<double, 3> three(const Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

/// Data arrays as raw bytes behind the XML part of a VTK file, a third of their size as text.
class RawArrays {
public:
    /// \return the array's line in the XML part
    template <typename T>
    std::string add(const char* type, const std::string& name, int components, const std::vector<T>& values) {
        const std::string line =
            fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n", type, name,
                        components, bytes_.size());
        const std::uint64_t size = values.size() * sizeof(T);
        bytes_.append(reinterpret_cast<const char*>(&size), sizeof size);
        bytes_.append(reinterpret_cast<const char*>(values.data()), size);
        return line;
    }
    std::string text() const { return "<AppendedData encoding=\"raw\">\n_" + bytes_ + "\n</AppendedData>\n"; }

private:
    std::string bytes_;
};

/// One of `every` values of x, y and z in turn.
std::vector<float> interleaved(const std::array<std::vector<double>, 3>& values, std::size_t every) {
    std::vector<float> result;
    for (std::size_t n = 0; n < values[0].size(); n += every)
        for (const auto& component : values) result.push_back(static_cast<float>(component[n]));
    return result;
}

}  // namespace

SurfaceRecorder::SurfaceRecorder(const std::filesystem::path& folder, double start_time, std::vector<Gauge> gauges, int every)
    : folder_(folder / "postProcessing"), gauges_(std::move(gauges)), every_(every) {
    const std::string start = fmt::format("{:g}", start_time);
    balance_ =
        open_rows(folder_ / "balance" / start / "balance.csv",
                  "time_s,step_s,occupied_volume_m3,volume_error,energy_j,pressure_impulse_error_n_s,body_impulse_error,gap_impulse_n_s,"
                  "pushed_out,deepest_m,pressure_iterations,even_out_iterations,residual,enclosed_waters,through_walls,core_s");
    levels_ = open_rows(folder_ / "levels" / start / "levels.csv",
                        "time_s,level_m,level_in_pipe_m,mouth_flow_m3_s,hole_flow_m3_s,volume_in_pipe_m3,bodies_in_pipe,rise_in_pipe_m_s,"
                        "mean_x_m,mean_z_m,farthest_x_m");
    rows_ = open_rows(
        folder_ / "bodies" / start / "bodies.csv",
        "time_s,id,x_m,z_m,vx_m_s,vz_m_s,spin_y_rad_s,water_force_x_n,water_force_z_n,contact_force_x_n,contact_force_z_n,y_m,vy_m_s");
    if (!gauges_.empty()) gauge_rows_ = open_rows(folder_ / "gauges" / start / "gauges.csv", "time_s,gauge,level_m,pressure_pa");
}

void SurfaceRecorder::step(const SurfaceRun& run, const SceneReading& reading, double core_seconds) {
    const StepReport& report = run.last();
    fmt::print(balance_, "{:.9g},{:.6g},{:.9g},{:.6g},{:.9g},{:.3g},{:.3g},{:.4g},{},{:.4g},{},{},{:.3g},{},{},{:.2f}\n", report.time,
               report.step, report.occupied_volume, run.initial_volume() > 0.0 ? report.occupied_volume / run.initial_volume() - 1.0 : 0.0,
               run.energy(), report.impulses.sum().norm(), report.body_impulse_error, report.gap_impulse, report.pushed_out, report.deepest,
               report.pressure.iterations, report.even_out.iterations, report.pressure.residual, report.enclosed_waters,
               report.through_walls, core_seconds);
    fmt::print(levels_, "{:.9g},{:.6g},{:.6g},{:.6g},{:.6g},{:.8g},{},{:.6g},{:.7g},{:.7g},{:.7g}\n", report.time, reading.level,
               reading.level_in_pipe, reading.mouth_flow, reading.hole_flow, reading.volume_in_pipe, reading.bodies_in_pipe,
               reading.rise_in_pipe, reading.mean_place.x(), reading.mean_place.z(), reading.farthest);
    for (const Gauge& gauge : gauges_) {
        const GaugeReading at = read_gauge(run, gauge);
        fmt::print(gauge_rows_, "{:.9g},{},{:.6g},{}\n", report.time, gauge.name, at.level,
                   gauge.z ? fmt::format("{:.6g}", at.pressure) : "");
    }
}

void SurfaceRecorder::output(const SurfaceRun& run, const coupling::DemEngine* bodies) {
    const std::string name = fmt::format("{:.6f}", run.time());
    write_water(run, name);
    write_series("water", "vti");
    if (every_ > 0) {
        write_particles(run, name);
        write_series("particles", "vtp");
    }
    if (bodies) {
        const StepReport& report = run.last();
        for (std::size_t b = 0; b < run.bodies().size(); ++b) {
            const Body& body = run.bodies()[b];
            const Vec3 water = b < report.body_force.size() ? report.body_force[b] : Vec3(Vec3::Zero());
            const Vec3 contact = b < report.contact_force.size() ? report.contact_force[b] : Vec3(Vec3::Zero());
            fmt::print(rows_, "{:.9g},{},{:.9g},{:.9g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.9g},{:.6g}\n", run.time(),
                       bodies->rocks().id[b], body.position.x(), body.position.z(), body.velocity.x(), body.velocity.z(), body.spin.y(),
                       water.x(), water.z(), contact.x(), contact.z(), body.position.y(), body.velocity.y());
        }
        write_bodies(run, name);
        write_series("bodies", "vtp");
    }
    flush();
}

void SurfaceRecorder::flush() {
    for (std::ofstream* stream : {&balance_, &levels_, &rows_, &gauge_rows_}) {
        if (!stream->is_open()) continue;
        stream->flush();
        require_written(*stream, folder_);
    }
}

void SurfaceRecorder::write_water(const SurfaceRun& run, const std::string& name) const {
    const StaggeredGrid& grid = run.grid();
    std::vector<int> cells;
    grid.for_each_cell([&](int cell, int, int, int) { cells.push_back(cell); });
    const std::string extent = fmt::format("0 {} 0 {} 0 {}", grid.cells(0), grid.cells(1), grid.cells(2));
    const auto velocity = [&](std::size_t n) {
        Vec3 mean = Vec3::Zero();
        if (run.water().kind[cells[n]] == CellKind::water) {
            for (const int d : grid.directions())
                mean[d] = 0.5 * (run.velocity()[d][cells[n]] + run.velocity()[d][cells[n] + grid.stride(d)]);
        }
        return three(mean);
    };
    const auto cell_value = [&](const CellField& field) { return [&](std::size_t n) { return std::array<double, 1>{field[cells[n]]}; }; };
    write_file(
        folder_ / "water" / "vtk" / ("water_" + name + ".vti"),
        fmt::format(
            "<VTKFile type=\"ImageData\" version=\"1.0\">\n<ImageData WholeExtent=\"{0}\" Origin=\"0 0 0\" Spacing=\"{1:.9g} {2:.9g} "
            "{1:.9g}\">\n<Piece Extent=\"{0}\">\n<CellData>\n",
            extent, grid.spacing(), grid.width(1)) +
            data_array("water_fraction", 1, cells.size(), cell_value(run.water().fraction)) +
            data_array("open_volume", 1, cells.size(), cell_value(run.cells().open_volume)) +
            data_array("pressure_pa", 1, cells.size(), cell_value(run.pressure())) + data_array("velocity_m_s", 3, cells.size(), velocity) +
            "</CellData>\n</Piece>\n</ImageData>\n</VTKFile>\n");
}

void SurfaceRecorder::write_particles(const SurfaceRun& run, const std::string& name) const {
    const WaterParticles& water = run.particles();
    const auto every = static_cast<std::size_t>(every_);
    std::vector<std::uint8_t> boxes;
    std::vector<std::int32_t> numbers;
    for (std::size_t p = 0; p < water.size(); p += every) {
        boxes.push_back(water.dye[p]);
        numbers.push_back(static_cast<std::int32_t>(numbers.size()));
    }
    const std::vector<std::int32_t> end{static_cast<std::int32_t>(numbers.size())};  // of the only cell, which has all points
    RawArrays arrays;
    std::string text = fmt::format(
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n"
        "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"1\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<PointData>\n",
        numbers.size());
    text += arrays.add("Float32", "velocity_m_s", 3, interleaved(water.velocity, every));
    text += arrays.add("UInt8", "filled_box", 1, boxes);
    text += "</PointData>\n<Points>\n" + arrays.add("Float32", "Points", 3, interleaved(water.position, every)) + "</Points>\n<Verts>\n";
    text += arrays.add("Int32", "connectivity", 1, numbers);
    text += arrays.add("Int32", "offsets", 1, end);
    text += "</Verts>\n</Piece>\n</PolyData>\n" + arrays.text() + "</VTKFile>\n";
    write_file(folder_ / "particles" / "vtk" / ("particles_" + name + ".vtp"), text);
}

void SurfaceRecorder::write_bodies(const SurfaceRun& run, const std::string& name) const {
    const std::vector<Body>& bodies = run.bodies();
    const StepReport& report = run.last();
    const auto force = [&](const std::vector<Vec3>& of, std::size_t n) { return three(n < of.size() ? of[n] : Vec3(Vec3::Zero())); };
    std::string vertices, offsets;
    for (std::size_t n = 0; n < bodies.size(); ++n) {
        vertices += fmt::format("{} ", n);
        offsets += fmt::format("{} ", n + 1);
    }
    write_file(folder_ / "bodies" / "vtk" / ("bodies_" + name + ".vtp"),
               fmt::format("<VTKFile type=\"PolyData\" version=\"1.0\">\n<PolyData>\n<Piece NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\" "
                           "NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<PointData>\n",
                           bodies.size()) +
                   data_array("radius_m", 1, bodies.size(), [&](std::size_t n) { return std::array<double, 1>{bodies[n].radius}; }) +
                   data_array("velocity_m_s", 3, bodies.size(), [&](std::size_t n) { return three(bodies[n].velocity); }) +
                   data_array("spin_rad_s", 3, bodies.size(), [&](std::size_t n) { return three(bodies[n].spin); }) +
                   data_array("water_force_n", 3, bodies.size(), [&](std::size_t n) { return force(report.body_force, n); }) +
                   data_array("contact_force_n", 3, bodies.size(), [&](std::size_t n) { return force(report.contact_force, n); }) +
                   "</PointData>\n<Points>\n" +
                   data_array("Points", 3, bodies.size(), [&](std::size_t n) { return three(bodies[n].position); }) +
                   "</Points>\n<Verts>\n<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n" + vertices +
                   "\n</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n" + offsets +
                   "\n</DataArray>\n</Verts>\n</Piece>\n</PolyData>\n</VTKFile>\n");
}

/// From the files that are there, so that a resumed run's series is whole.
void SurfaceRecorder::write_series(const std::string& what, const std::string& extension) const {
    const std::filesystem::path files = folder_ / what / "vtk";
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(files)) {
        if (entry.path().extension() == "." + extension) names.push_back(entry.path().filename().string());
    }
    const auto time_of = [&](const std::string& name) { return std::strtod(name.c_str() + what.size() + 1, nullptr); };
    std::sort(names.begin(), names.end(), [&](const auto& a, const auto& b) { return time_of(a) < time_of(b); });
    std::string text = "<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
    for (const std::string& name : names) text += fmt::format("<DataSet timestep=\"{:g}\" file=\"vtk/{}\"/>\n", time_of(name), name);
    write_file(folder_ / what / (what + ".pvd"), text + "</Collection>\n</VTKFile>\n");
}

}  // namespace cutterflow::free_surface
