// Measured velocities: reading the file, the places that the model is sampled at, and the comparison, against an analytic field.
#include "postproc/pages/adv_page.hpp"
#include "postproc/pages/adv_trend.hpp"
#include "postproc/run/run_reader.hpp"

#include <regex>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "geometry/base/error.hpp"
#include "geometry/base/run_files.hpp"
#include "postproc/tests/synthetic_run.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::SmallRun;

const double k_omega = rpm_to_rad_s(60.0);

/// Absolute velocity, Cartesian, at a place in the instrument's frame: a swirl with a shear and a source, and what a turning instrument
/// sees of the blades' flow.
Vec3 field(const Vec3& x) {
    return {0.3 * x[0] - 2.0 * x[1] + 0.4 * x[2], 2.0 * x[0] + 0.3 * x[1] + 0.1, -0.6 * x[2] + 0.7 * x[0] + 0.2};
}
using Field = Vec3 (*)(const Vec3&);

/// A vortex about the axis whose swirl peaks at 0.2 m, sucked up more strongly the nearer to the axis: every component is curved in radius
/// and height.
Vec3 vortex(const Vec3& x) {
    const double r2 = (x[0] * x[0] + x[1] * x[1]) / 0.04, swirl = 6.0 * std::exp(-0.5 * r2) * std::cos(4.0 * x[2]);
    const double inflow = -2.0 * std::exp(-r2) * (1.0 + 3.0 * x[2]);
    return {inflow * x[0] - swirl * x[1], inflow * x[1] + swirl * x[0], 1.5 * std::exp(-r2) * std::sin(5.0 * x[2])};
}

/// Mean of a field over a cylinder along the axis of z, by the midpoint rule on 40 x 60 x 40 cells.
Vec3 mean_over_cylinder(Field flow, const Vec3& centre, double diameter, double length) {
    constexpr int rings = 40, sectors = 60, layers = 40;
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < sectors; ++j)
            for (int k = 0; k < layers; ++k) {
                const double r = 0.5 * diameter * std::sqrt((i + 0.5) / rings),
                             a = 2.0 * k_pi * (j + 0.5) / sectors;  // rings of equal area
                sum += flow(centre + Vec3(r * std::cos(a), r * std::sin(a), length * ((k + 0.5) / layers - 0.5)));
            }
    return sum / (rings * sectors * layers);
}

const Eigen::Matrix3d k_gradient = (Eigen::Matrix3d() << 0.3, -2.0, 0.4, 2.0, 0.3, 0.0, 0.7, 0.0, -0.6).finished();

/// Writes postProcessing/velocity as a run does, with scatter between the revolutions.
class AdvRun : public ::testing::Test {
protected:
    AdvRun() : run("adv") {
        run.with_rock = false;
        run.write();
    }
    void write_sampled(const std::vector<AdvPoint>& points, const std::vector<double>& scatter, Field flow = field) {
        const AdvProbe probe = read_run(run.directory).adv_probe;
        std::string places =
            "point,x_m,y_m,z_m,rotating,u_radial_m_s,u_tangential_m_s,u_axial_m_s,se_radial_m_s,se_tangential_m_s,se_axial_m_s,samples,"
            "dry_samples,revolutions,from_s,to_s\n";
        std::vector<std::string> rows;
        for (const AdvPoint& point : points)
            for (const Vec3& x : adv_places(point, probe)) {
                const double a = std::atan2(x[1], x[0]);
                const Vec3 u = flow(x), radial(std::cos(a), std::sin(a), 0.0), tangential(-std::sin(a), std::cos(a), 0.0);
                places += fmt::format("{},{:.9g},{:.9g},{:.9g},{},0,0,0,,,,240,0,{},1,2\n", rows.size() + 1, x[0], x[1], x[2],
                                      point.rotating ? 1 : 0, scatter.size());
                const bool dry = x[2] > 0.999;
                rows.push_back(dry ? std::string() : fmt::format("{:.9g}|{:.9g}|{:.9g}", u.dot(radial), u.dot(tangential), u[2]));
            }
        std::string revolutions = "revolution,point,u_radial_m_s,u_tangential_m_s,u_axial_m_s,wet_share\n";
        for (std::size_t n = 0; n < scatter.size(); ++n)
            for (std::size_t i = 0; i < rows.size(); ++i) {
                if (rows[i].empty()) {
                    revolutions += fmt::format("{},{},,,,0\n", n + 1, i + 1);
                    continue;
                }
                const auto bar = rows[i].rfind('|');
                std::string text = rows[i].substr(0, bar);
                std::replace(text.begin(), text.end(), '|', ',');
                revolutions += fmt::format("{},{},{},{:.9g},1\n", n + 1, i + 1, text, std::stod(rows[i].substr(bar + 1)) + scatter[n]);
            }
        testing::write_text(run.directory / "postProcessing/velocity/0/adv.csv", places);
        testing::write_text(run.directory / "postProcessing/velocity/0/adv_revolutions.csv", revolutions);
    }
    fs::path points_file(const std::string& lines) {
        const fs::path file = run.directory / "points.csv";
        testing::write_text(file, "name,r_mm,theta_deg,z_mm,frame,u_radial_cm_s,u_tangential_cm_s,u_axial_cm_s\n" + lines);
        return file;
    }
    SmallRun run;
};

std::string refusal(const fs::path& file) {
    try {
        read_adv_points(file);
        return "accepted";
    } catch (const UserError& error) {
        return error.what();
    }
}

}  // namespace

TEST(AdvPoints, are_read_in_any_unit_order_and_coordinates) {
    const fs::path folder = testing::fresh_directory("adv_points");
    testing::write_text(folder / "a.csv",
                        "# a comment\nframe, z_cm, u_axial_mm_s, name, y_m, x_mm, u_radial_m_s, u_tangential_cm_s\n"
                        "still, -10, 250, A 1, 0.3, 400, 0.5, -20\n\nrotating,-20,,B,0,100,,\n");
    const std::vector<AdvPoint> points = read_adv_points(folder / "a.csv");
    ASSERT_EQ(points.size(), 2u);
    EXPECT_EQ(points[0].name, "A 1");
    EXPECT_NEAR(points[0].place.radius, 0.5, 1e-12);
    EXPECT_NEAR((points[0].position() - Vec3(0.4, 0.3, -0.1)).norm(), 0.0, 1e-12);
    EXPECT_NEAR(*points[0].measured[0], 0.5, 1e-15);
    EXPECT_NEAR(*points[0].measured[1], -0.2, 1e-15);
    EXPECT_NEAR(*points[0].measured[2], 0.25, 1e-15);
    EXPECT_FALSE(points[0].rotating);
    EXPECT_TRUE(points[1].rotating);
    EXPECT_FALSE(points[1].measured[1]);
    testing::write_text(folder / "template.csv", "\xEF\xBB\xBF" + adv_template());  // as a spreadsheet saves it
    EXPECT_EQ(read_adv_points(folder / "template.csv").size(), 3u);
}

TEST(AdvPoints, names_every_mistake_of_a_file_at_once) {
    const fs::path folder = testing::fresh_directory("adv_mistakes");
    const fs::path file = folder / "points.csv";
    testing::write_text(file, "name,r_inch,theta_deg,z_mm,u_radial_cm_s,u_tangential_knots,depth\nA,1,2,3,4,5\n");
    const std::string header = refusal(file);
    for (const char* part : {"points.csv:1: column frame is missing", "column \"r_inch\" has no known unit. It is one of r_cm, r_m, r_mm",
                             "column \"u_tangential_knots\" has no known unit", "column u_axial is missing",
                             "column \"depth\" is unknown or duplicate", "points.csv:2: 6 fields instead of 7"})
        EXPECT_THAT(header, HasSubstr(part));
    testing::write_text(
        file,
        "name,r_mm,theta_deg,z_mm,frame,u_radial_cm_s,u_tangential_cm_s,u_axial_cm_s\n"
        "A,100,0,-50,still,1,2,3\nA,100,0,-50,moving,1,2,3\nB,-1,x,-50,still,1,2,3\n,1,2,3,still,nan,2,3\nC,1,2,3,still,1,2\n");
    const std::string lines = refusal(file);
    for (const char* part : {"points.csv:3: the name \"A\" is also in", "points.csv:3: frame = \"moving\"", "points.csv:4: r = -0.001 m",
                             "points.csv:4: theta_deg = \"x\" is not a number", "points.csv:5: the name is empty",
                             "points.csv:5: u_radial_cm_s = \"nan\" is not a number", "points.csv:6: 7 fields instead of 8"})
        EXPECT_THAT(lines, HasSubstr(part));
    testing::write_text(file, "# nothing\n");
    EXPECT_THAT(refusal(file), HasSubstr("no header line"));
    testing::write_text(file, "name;x_mm;y_mm\nA;1;2\n");
    EXPECT_THAT(refusal(file), HasSubstr("separated by semicolons or tabs"));
}

TEST(AdvPlaces, average_a_cubic_field_over_the_probes_volume_exactly) {
    AdvPoint point;
    point.place = {0.3, 0.7, -0.1};
    const AdvProbe probe{0.1, 0.2, 0.01};
    const std::vector<Vec3> places = adv_places(point, probe);
    ASSERT_EQ(places.size(), k_adv_places);
    const Vec3 centre = point.position(), radial = point.direction(AdvComponent::radial);
    // Mean over a cylinder: of the square of the distance along a diameter R^2/4, along the axis L^2/12; odd powers vanish.
    double across = 0.0, along = 0.0, odd = 0.0;
    for (std::size_t i = 0; i < k_probe_places; ++i) {
        const double s = (places[i] - centre).dot(radial), z = places[i][2] - centre[2];
        across += s * s / k_probe_places;
        along += z * z / k_probe_places;
        odd += (s * s * s + z * z * z + s * z * z) / k_probe_places;
    }
    EXPECT_NEAR(across, 0.05 * 0.05 / 4.0, 1e-15);
    EXPECT_NEAR(along, 0.2 * 0.2 / 12.0, 1e-15);
    EXPECT_NEAR(odd, 0.0, 1e-15);
}

TEST_F(AdvRun, means_and_position_bars_are_those_of_the_field) {
    // Inside the head below its contour, outside beside it, and one that turns.
    const fs::path file = points_file("in,100,30,-50,still,10,20,30\nout,450,200,-50,still,,,\nturning,200,90,-100,rotating,,,\n");
    const std::vector<AdvPoint> points = read_adv_points(file);
    write_sampled(points, {0.3, 0.0, 0.1, -0.1});
    const AdvComparison comparison = compare_with_measurement(run.directory, file, 3);
    ASSERT_EQ(comparison.points.size(), 3u);
    EXPECT_EQ(comparison.revolutions, 3);
    EXPECT_TRUE(comparison.points[0].inside);
    EXPECT_FALSE(comparison.points[1].inside);
    for (std::size_t p = 0; p < 3; ++p) {
        const AdvPoint& point = points[p];
        Vec3 mean = field(point.position());
        Eigen::Matrix3d gradient = k_gradient;
        if (point.rotating) {
            // Relative to the head: the swirl loses omega.
            mean -= k_omega * Vec3::UnitZ().cross(point.position());
            gradient(0, 1) += k_omega;
            gradient(1, 0) -= k_omega;
        }
        for (const AdvComponent c : k_adv_components) {
            const AdvVelocity& v = comparison.points[p].velocity[static_cast<std::size_t>(c)];
            const Vec3 direction = point.direction(c);
            EXPECT_NEAR(*v.model, mean.dot(direction), 1e-6) << point.name;  // the last three revolutions' scatter is 0 in the mean
            EXPECT_NEAR(*v.position_bar, 0.01 * (gradient.transpose() * direction).norm(), 1e-6) << point.name;
            // Axial batches 0, 0.1, -0.1: sqrt(0.02 / 6).
            EXPECT_NEAR(*v.statistical_error, c == AdvComponent::axial ? std::sqrt(0.02 / 6.0) : 0.0, 1e-6);
        }
        EXPECT_NEAR(comparison.points[p].wet_share, 1.0, 1e-12);
    }
    EXPECT_NEAR(*compare_with_measurement(run.directory, file).points[0].velocity[2].model, field(points[0].position())[2] + 0.075, 1e-6);
    EXPECT_THROW(compare_with_measurement(run.directory, file, 5), UserError);
}

TEST_F(AdvRun, mean_over_a_large_probe_is_that_of_a_curved_vortex) {
    // 60 mm x 90 mm, ten times the instrument: what the curvature does is then above the tolerance.
    const fs::path study = run.directory / "study.resolved.toml";
    testing::write_text(study, std::regex_replace(testing::read_text(study), std::regex("\\[report\\]"),
                                                  "[report]\nadv_probe_diameter_m = 0.06\nadv_probe_length_m = 0.09"));
    const fs::path file = points_file("near,120,30,-100,still,,,\nfar,260,200,-250,still,,,\nturning,180,90,-180,rotating,,,\n");
    const std::vector<AdvPoint> points = read_adv_points(file);
    write_sampled(points, {0.0, 0.0}, vortex);
    const AdvComparison comparison = compare_with_measurement(run.directory, file);
    ASSERT_NEAR(comparison.probe.diameter, 0.06, 1e-12);
    double curvature = 0.0;
    for (std::size_t p = 0; p < points.size(); ++p) {
        const Vec3 centre = points[p].position(),
                   frame = points[p].rotating ? Vec3(k_omega * Vec3::UnitZ().cross(centre)) : Vec3(Vec3::Zero());
        const Vec3 mean = mean_over_cylinder(vortex, centre, 0.06, 0.09);
        curvature = std::max(curvature, (mean - vortex(centre)).norm() / mean.norm());
        for (const AdvComponent c : k_adv_components)
            EXPECT_NEAR(*comparison.points[p].velocity[static_cast<std::size_t>(c)].model, (mean - frame).dot(points[p].direction(c)),
                        1e-3 * mean.norm())
                << points[p].name << ", " << adv_component_name(c);
    }
    EXPECT_GT(curvature, 0.01) << "the velocity in the middle of the volume alone would do";
}

TEST_F(AdvRun, agreement_is_bias_scatter_slope_and_hits_apart_inside_and_outside) {
    AdvComparison comparison;
    const auto add = [&](bool inside, std::array<double, 2> measured_and_model, double bar) {
        AdvResult result;
        result.inside = inside;
        result.velocity[0] = {measured_and_model[0], measured_and_model[1], bar, 0.0};
        comparison.points.push_back(result);
    };
    add(true, {1.0, 1.2}, 0.0);    // within a quarter
    add(true, {-0.5, -0.8}, 0.1);  // neither
    add(true, {0.1, 0.15}, 0.06);  // within the bar
    add(false, {2.0, 1.0}, 0.0);
    const AdvAgreement inside = agreement(comparison, true);
    EXPECT_EQ(inside.count, 3u);
    EXPECT_NEAR(inside.bias, (0.2 - 0.3 + 0.05) / 3.0, 1e-12);
    EXPECT_NEAR(inside.rmse, std::sqrt((0.04 + 0.09 + 0.0025) / 3.0), 1e-12);
    EXPECT_NEAR(*inside.slope, (1.2 + 0.4 + 0.015) / (1.0 + 0.25 + 0.01), 1e-12);
    EXPECT_NEAR(inside.hit_rate, 2.0 / 3.0, 1e-12);
    EXPECT_EQ(agreement(comparison, false).count, 1u);
    EXPECT_EQ(agreement(comparison, true, AdvComponent::axial).count, 0u);
}

TEST_F(AdvRun, refuses_points_that_the_run_did_not_sample) {
    const fs::path file = points_file("A,100,30,-50,still,10,20,30\n");
    try {
        compare_with_measurement(run.directory, file);
        FAIL() << "accepted";
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), HasSubstr("report.adv_points"));
    }
    write_sampled(read_adv_points(file), {0.0, 0.0});
    points_file("A,100,30,-50,rotating,10,20,30\nB,101,30,-50,still,,,\n");
    try {
        compare_with_measurement(run.directory, file);
        FAIL() << "accepted";
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), HasSubstr("points.csv:2: the run did not sample the point A"));
        EXPECT_THAT(error.what(), HasSubstr("points.csv:3: the run did not sample the point B"));
    }
}

TEST_F(AdvRun, refuses_revolutions_that_its_table_does_not_hold) {
    const fs::path file = points_file("A,100,30,-50,still,10,20,30\n");
    write_sampled(read_adv_points(file), {0.0, 0.1});
    EXPECT_NO_THROW(compare_with_measurement(run.directory, file));
    const fs::path table = run.directory / "postProcessing/velocity/0/adv_revolutions.csv";
    const std::string text = testing::read_text(table);
    testing::write_text(table, text.substr(0, text.rfind('\n', text.size() - 2) + 1));
    EXPECT_THROW(compare_with_measurement(run.directory, file), UserError);
}

TEST_F(AdvRun, trends_refuse_documents_with_values_of_another_kind) {
    for (const char* text : {R"({"schema": 1})", R"({"schema": "SCHEMA", "points": 3})",
                             R"({"schema": "SCHEMA", "speed_rpm": 60, "discharge_m3_s": 0.1, "points": [{"name": "A", "radial": {}}]})"}) {
        std::string document = text;
        if (const auto at = document.find("SCHEMA"); at != std::string::npos) document.replace(at, 6, k_adv_schema);
        testing::write_text(run.directory / names::adv_json, document);
        EXPECT_THROW(read_adv_trends({run.directory}), UserError) << document;
    }
}

TEST_F(AdvRun, trends_follow_named_points_over_the_runs_of_a_sweep) {
    std::vector<fs::path> runs;
    for (const double rpm : {60.0, 30.0, 90.0}) {
        AdvComparison comparison;
        comparison.speed_rpm = rpm;
        for (const char* name : {"A", rpm > 60.0 ? "C" : "B"}) {
            AdvResult result;
            result.point.name = name;
            result.velocity[1] = {0.01 * rpm, 0.011 * rpm, 0.1, 0.0};
            comparison.points.push_back(result);
        }
        runs.push_back(run.directory / fmt::format("{}", rpm));
        write_adv_report(comparison, runs.back());
    }
    runs.push_back(run.directory / "without");
    const std::vector<AdvTrend> trends = read_adv_trends(runs);
    ASSERT_EQ(trends.size(), 6u);  // A and B in three components; C was named once
    EXPECT_EQ(trends[1].point, "A");
    EXPECT_EQ(trends[1].component, "tangential");
    ASSERT_EQ(trends[1].values.size(), 3u);
    EXPECT_EQ(trends[1].values[0].speed_rpm, 30.0);
    EXPECT_NEAR(*trends[1].values[2].model, 0.99, 1e-12);
    EXPECT_EQ(trends[4].values.size(), 2u);
    EXPECT_FALSE(trends[0].values[0].model);
    const std::string section = adv_trend_section(trends, Page(run.directory / "trends.html", PageForm::live));
    EXPECT_THAT(section, HasSubstr("<svg"));
    EXPECT_THAT(section, HasSubstr("0.990 ± 0.100<br>(0.900)"));
    EXPECT_THAT(section, HasSubstr("<th scope=\"col\">30 rpm</th><th scope=\"col\">60 rpm</th><th scope=\"col\">90 rpm</th>"));
}

TEST_F(AdvRun, page_and_document_hold_every_point_and_escape_its_name) {
    const fs::path file = points_file("<b>in</b>,100,30,-50,still,10,20,30\nout,450,200,-50,still,-30,80,10\n");
    write_sampled(read_adv_points(file), {0.1, 0.0});
    const AdvComparison comparison = compare_with_measurement(run.directory, file);
    const std::string page = testing::read_text(write_adv_report(comparison, run.directory));
    EXPECT_THAT(page, HasSubstr("&lt;b&gt;in&lt;/b&gt;"));
    EXPECT_EQ(page.find("<b>in"), std::string::npos);
    const nlohmann::json document = nlohmann::json::parse(testing::read_text(run.directory / "report/adv.json"));
    EXPECT_EQ(document["schema"], k_adv_schema);
    EXPECT_EQ(document["points"].size(), 2u);
    EXPECT_NEAR(document["points"][1]["tangential"]["measured_m_s"].get<double>(), 0.8, 1e-12);
    EXPECT_EQ(document["agreement"]["inside_head"]["all"]["count"], 3);
    EXPECT_EQ(document["agreement"]["outside_head"]["radial"]["count"], 1);
    EXPECT_THAT(adv_text(comparison), HasSubstr("inside the head, 3 values: bias"));
}

}  // namespace cutterflow::postproc
