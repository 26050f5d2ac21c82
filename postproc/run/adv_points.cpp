#include "postproc/run/adv_points.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"

namespace cutterflow::postproc {
namespace {

using Units = std::map<std::string, double>;
const Units k_lengths{{"m", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}};
const Units k_angles{{"deg", k_pi / 180.0}, {"rad", 1.0}};
const Units k_velocities{{"m_s", 1.0}, {"cm_s", 1e-2}, {"mm_s", 1e-3}};

/// A quantity of the table and its allowed units.
struct Quantity {
    const char* name;
    const Units* units;
};
constexpr Quantity k_x{"x", &k_lengths}, k_y{"y", &k_lengths}, k_r{"r", &k_lengths}, k_theta{"theta", &k_angles}, k_z{"z", &k_lengths};
constexpr std::array<Quantity, 3> k_measured{{{"u_radial", &k_velocities}, {"u_tangential", &k_velocities}, {"u_axial", &k_velocities}}};

constexpr const char* k_byte_order_mark = "\xEF\xBB\xBF";  // as spreadsheets write it

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(" \t\r");
    return first == std::string::npos ? std::string() : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> fields_of(const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(trimmed(field));
    if (!line.empty() && line.back() == ',') fields.emplace_back();
    return fields;
}

std::string units_text(const Quantity& quantity) {
    std::vector<std::string> names;
    for (const auto& [unit, factor] : *quantity.units) names.push_back(fmt::format("{}_{}", quantity.name, unit));
    return fmt::format("{}", fmt::join(names, ", "));
}

/// Column and conversion factor of a quantity.
struct Column {
    std::size_t index = 0;
    double factor = 1.0;
};

/// Reads one file and collects its mistakes.
class Reader {
public:
    explicit Reader(const std::filesystem::path& file) : name_(file.string()) {
        std::istringstream lines(read_file(file));
        int number = 0;
        for (std::string line; std::getline(lines, line);) {
            if (++number == 1 && line.rfind(k_byte_order_mark, 0) == 0) line.erase(0, std::string(k_byte_order_mark).size());
            if (trimmed(line).empty() || trimmed(line).front() == '#') continue;
            if (header_.empty())
                read_header(line, number);
            else
                read_line(line, number);
        }
        if (header_.empty())
            add(name_, "the file has no header line", "It names the columns and their units",
                "Start from a template: cutterflow report --adv-template");
        if (mistakes_.empty() && points_.empty())
            add(name_, "the file has no points", "One line below the header is one point", "Add lines");
        if (!mistakes_.empty()) throw UserError(std::move(mistakes_));
    }
    std::vector<AdvPoint> points() { return std::move(points_); }

private:
    void add(const std::string& where, const std::string& what, const std::string& rule, const std::string& remedy) {
        mistakes_.push_back({where, what, rule, remedy});
    }

    void read_header(const std::string& line, int number) {
        const std::string where = fmt::format("{}:{}", name_, number);
        header_ = fields_of(line);
        if (header_.size() == 1 && line.find_first_of(";\t") != std::string::npos) {
            add(where, fmt::format("the columns of \"{}\" are separated by semicolons or tabs", trimmed(line)),
                "Columns are separated by commas; the decimal sign is a point", "Export the table again, or replace them");
            throw UserError(std::move(mistakes_));
        }
        read_as_.resize(header_.size());
        std::vector<Quantity> wanted{k_z};
        cylindrical_ = std::any_of(header_.begin(), header_.end(),
                                   [](const std::string& c) { return c.rfind("r_", 0) == 0 || c.rfind("theta_", 0) == 0; });
        for (const Quantity& quantity : cylindrical_ ? std::array<Quantity, 2>{k_r, k_theta} : std::array<Quantity, 2>{k_x, k_y})
            wanted.push_back(quantity);
        wanted.insert(wanted.end(), k_measured.begin(), k_measured.end());
        for (const Quantity& quantity : wanted) find_quantity(quantity, where);
        for (const char* text : {"name", "frame"}) {
            const auto found = std::find(header_.begin(), header_.end(), text);
            if (found == header_.end())
                add(where, fmt::format("column {} is missing", text), "Every point has a name and a frame (still or rotating)",
                    "Add the column");
            else
                texts_[text] = use(found);
        }
        for (std::size_t i = 0; i < header_.size(); ++i)
            if (!read_as_[i])
                add(where, fmt::format("column \"{}\" is unknown or duplicate", header_[i]),
                    "Columns are name, x y z or r theta z, frame, u_radial, u_tangential, u_axial with their units", "Rename or remove it");
        good_header_ = mistakes_.empty();
    }

    std::size_t use(std::vector<std::string>::const_iterator column) {
        const auto index = static_cast<std::size_t>(column - header_.begin());
        read_as_[index] = true;
        return index;
    }

    void find_quantity(const Quantity& quantity, const std::string& where) {
        const std::string start = std::string(quantity.name) + "_";
        const auto found = std::find_if(header_.begin(), header_.end(),
                                        [&](const std::string& column) { return column.rfind(start, 0) == 0 || column == quantity.name; });
        if (found == header_.end())
            return add(where, fmt::format("column {} is missing", quantity.name),
                       fmt::format("Its name contains its unit: {}", units_text(quantity)), "Add the column");
        const std::size_t index = use(found);
        const auto unit = quantity.units->find(found->size() > start.size() ? found->substr(start.size()) : std::string());
        if (unit == quantity.units->end())
            return add(where, fmt::format("column \"{}\" has no known unit", *found), fmt::format("It is one of {}", units_text(quantity)),
                       "Rename the column");
        columns_[quantity.name] = {index, unit->second};
    }

    void read_line(const std::string& line, int number) {
        const std::string where = fmt::format("{}:{}", name_, number);
        const std::vector<std::string> fields = fields_of(line);
        if (fields.size() != header_.size())
            return add(where, fmt::format("{} fields instead of {}", fields.size(), header_.size()),
                       "Every line has one field per column of the header", "Complete the line");
        if (!good_header_) return;  // what the columns mean is not known
        const std::size_t before = mistakes_.size();
        AdvPoint point;
        point.where = where;
        point.name = fields[texts_.at("name")];
        read_texts(fields, point);
        const double z = number_in(k_z, fields, where).value_or(0.0);
        const Quantity& first = cylindrical_ ? k_r : k_x;
        const Quantity& second = cylindrical_ ? k_theta : k_y;
        const double a = number_in(first, fields, where).value_or(0.0), b = number_in(second, fields, where).value_or(0.0);
        if (cylindrical_ && a < 0.0) add(where, fmt::format("r = {} m", a), "A radius is not negative", "Correct the field");
        point.place = cylindrical_ ? Cylindrical{a, b, z} : to_cylindrical({}, Vec3::UnitX(), Vec3(a, b, z));
        for (std::size_t c = 0; c < 3; ++c)
            if (!fields[columns_.at(k_measured[c].name).index].empty()) point.measured[c] = number_in(k_measured[c], fields, where);
        if (mistakes_.size() == before) points_.push_back(std::move(point));
    }

    void read_texts(const std::vector<std::string>& fields, AdvPoint& point) {
        if (point.name.empty()) add(point.where, "the name is empty", "Every point has a unique name", "Name the point");
        const auto [first, fresh] = names_.emplace(point.name, point.where);
        if (!fresh)
            add(point.where, fmt::format("the name \"{}\" is also in {}", point.name, first->second), "Every point has a unique name",
                "Rename one of them");
        const std::string& frame = fields[texts_.at("frame")];
        point.rotating = frame == "rotating";
        if (frame != "rotating" && frame != "still")
            add(point.where, fmt::format("frame = \"{}\"", frame), "It is still (at rest) or rotating (turns with the head)",
                "Correct the field");
    }

    std::optional<double> number_in(const Quantity& quantity, const std::vector<std::string>& fields, const std::string& where) {
        const Column& column = columns_.at(quantity.name);
        const std::string& field = fields[column.index];
        double value = 0.0;
        const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
        if (error == std::errc{} && end == field.data() + field.size() && std::isfinite(value)) return column.factor * value;
        add(where, fmt::format("{} = \"{}\" is not a number", header_[column.index], field), "Numbers are finite and have a decimal point",
            "Correct the field");
        return std::nullopt;
    }

    std::string name_;
    std::vector<std::string> header_;
    std::vector<bool> read_as_;  // of the header's columns
    bool cylindrical_ = false, good_header_ = false;
    std::map<std::string, Column> columns_;
    std::map<std::string, std::size_t> texts_;
    std::map<std::string, std::string> names_;
    std::vector<AdvPoint> points_;
    std::vector<Mistake> mistakes_;
};

}  // namespace

const char* adv_component_name(AdvComponent component) {
    constexpr const char* names[] = {"radial", "tangential", "axial"};
    return names[static_cast<std::size_t>(component)];
}

Vec3 AdvPoint::position() const {
    return {place.radius * std::cos(place.azimuth), place.radius * std::sin(place.azimuth), place.axial};
}

Vec3 AdvPoint::direction(AdvComponent component) const {
    if (component == AdvComponent::axial) return Vec3::UnitZ();
    const Vec3 radial(std::cos(place.azimuth), std::sin(place.azimuth), 0.0);
    return component == AdvComponent::radial ? radial : Vec3(Vec3::UnitZ().cross(radial));
}

std::vector<AdvPoint> read_adv_points(const std::filesystem::path& file) {
    return Reader(file).points();
}

std::string adv_template() {
    return "# Velocities measured at points, in the run's frame: z along the rotor's axis from hub to ring, ring plane z = 0 (the head "
           "lies\n"
           "# below it), theta = 0 on the lowest side, positive by the right hand about z. Instead of r and theta: x_mm,y_mm, x to the "
           "lowest side.\n"
           "# Units are in the header: lengths m, cm, mm; angles deg, rad; velocities m_s, cm_s, mm_s. An empty velocity was not "
           "measured.\n"
           "# frame: still, or rotating for an instrument that turns with the head (r, theta, z at rotor angle 0) and measures the "
           "velocity\n"
           "# relative to it. u_tangential is positive by the right hand about z. Lines that start with # are ignored.\n"
           "# In the study: report.adv_points = \"points.csv\".\n"
           "name,r_mm,theta_deg,z_mm,frame,u_radial_cm_s,u_tangential_cm_s,u_axial_cm_s\n"
           "A1,430,90,-60,still,,,\n"
           "A2,430,270,-60,still,,,\n"
           "B1,200,30,-140,rotating,,,\n";
}

std::vector<Vec3> adv_places(const AdvPoint& point, const AdvProbe& probe) {
    const Vec3 centre = point.position();
    const auto along = [&](AdvComponent component, double distance) { return Vec3(distance * point.direction(component)); };
    // Gauss: exact for cubic fields in a disc with four points at r / sqrt 2, along a line with two at l / (2 sqrt 3).
    const double arm = 0.5 * probe.diameter / std::sqrt(2.0), half = 0.5 * probe.length / std::sqrt(3.0);
    std::vector<Vec3> places;
    for (const double z : {-half, half})
        for (const AdvComponent side : {AdvComponent::radial, AdvComponent::tangential})
            for (const double sign : {-1.0, 1.0}) places.push_back(centre + along(AdvComponent::axial, z) + along(side, sign * arm));
    for (const AdvComponent component : k_adv_components)
        for (const double sign : {-1.0, 1.0}) places.push_back(centre + along(component, sign * probe.position_error));
    return places;
}

}  // namespace cutterflow::postproc
