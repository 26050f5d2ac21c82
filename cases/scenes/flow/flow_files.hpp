#pragma once
/// \file What the flow of every scene has alike: turbulence to start from, properties, schemes and solvers of the transient run.
#include <array>
#include <string>
#include <vector>

#include "meshing/dictionary/foam_dictionary.hpp"

namespace cutterflow::cases {

/// A dictionary with its place in the case.
struct FoamFile {
    std::string path;        ///< relative to the case
    std::string foam_class;  ///< "dictionary", "volVectorField" ...
    meshing::FoamDictionary contents;
};

FoamFile property_file(const std::string& name, meshing::FoamDictionary contents);  ///< constant/<name>
FoamFile system_file(const std::string& name, meshing::FoamDictionary contents);    ///< system/<name>

// Exponents of [kg m s K mol A cd].
inline constexpr std::array<int, 7> k_velocity_dimensions = {0, 1, -1, 0, 0, 0, 0};
inline constexpr std::array<int, 7> k_pressure_dimensions = {0, 2, -2, 0, 0, 0, 0};  ///< over density; of k as well
inline constexpr std::array<int, 7> k_dissipation_dimensions = {0, 2, -3, 0, 0, 0, 0};
inline constexpr std::array<int, 7> k_viscosity_dimensions = {0, 2, -1, 0, 0, 0, 0};

/// `uniform value`.
meshing::FoamValue uniform(meshing::FoamValue value);

/// A boundary condition (or any dictionary with a type).
meshing::FoamDictionary typed(const std::string& type);
meshing::FoamDictionary typed(const std::string& type, meshing::FoamValue value);

/// 0/<name>. \param patches  conditions by patch
FoamFile field_file(const std::string& name, const std::string& foam_class, const std::array<int, 7>& dimensions,
                    meshing::FoamValue internal, const meshing::FoamDictionary& patches);

/// k [m2/s2] and epsilon [m2/s3] of isotropic turbulence.
struct Turbulence {
    double k = 0.0;
    double epsilon = 0.0;
    double eddy_viscosity() const;  ///< 0.09 k^2 / epsilon [m2/s]
};

/// k = 1.5 (I U)^2, epsilon = 0.09^(3/4) k^(3/2) / L with the intensity I = 5 %.
/// \param speed   U [m/s] > 0
/// \param length  L [m] > 0
Turbulence turbulence_of(double speed, double length);

/// constant/transportProperties. \param density  [kg/m3] \param viscosity  kinematic [m2/s]
FoamFile transport_file(double density, double viscosity);

inline constexpr const char* k_laminar = "laminar";

/// constant/turbulenceProperties. \param model  a RAS model, or k_laminar
FoamFile turbulence_file(const std::string& model);

/// constant/g. \param gravity  [m/s2]
FoamFile gravity_file(const Vec3& gravity);

/// Scheme of momentum convection in the transient run.
enum class ConvectionScheme {
    upwind,         ///< first order
    linear_upwind,  ///< second order, from the upwind cell with its limited gradient; the matrix is that of upwind
};

/// How the transient flow is solved. docs/design/007-flow-settings.md has the measurements behind the defaults.
struct FlowNumerics {
    ConvectionScheme convection = ConvectionScheme::linear_upwind;
    double max_courant = 1.8;
    int outer_correctors = 1;
    int pressure_correctors = 2;
};

/// system/fvSchemes. \param limit  share of the non-orthogonal correction that is kept (0 to 1)
FoamFile schemes_file(const std::string& time_scheme, const meshing::FoamDictionary& convection, double limit);

/// One entry with a scheme of several words.
meshing::FoamDictionary one_scheme(const std::string& key, const std::string& scheme);

/// system/fvSchemes and fvSolution of the transient run, for cutterFoam and for stock pimpleFoam.
std::vector<FoamFile> run_numerics_files(const FlowNumerics& numerics);

/// A linear solver of U, k and epsilon.
meshing::FoamDictionary transport_solver(double tolerance, double relative);
/// Section of a multigrid solver or preconditioner. \param role  "solver" or "preconditioner"
meshing::FoamDictionary multigrid(const char* role);

}  // namespace cutterflow::cases
