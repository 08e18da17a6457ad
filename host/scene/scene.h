// A scene as plain values: what to simulate, in SI units. A test can build one without a file.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/names.h"
#include "core/packing.h"
#include "scene/programme.h"
#include "scene/species.h"

namespace mcdem::inline scene {

struct WallMaterial {
    double youngs_modulus = 50e6;  ///< [Pa]
    double poisson_ratio = 0.5;
    double friction = 0.03;     ///< mu, grain on wall
    double restitution = 0.95;  ///< e
};

struct ContactLaw {
    ContactModel model = ContactModel::mc_dem;
    double gamma = 1.125;  ///< prefactor of Eq. 1, used by mc_dem only
    FrictionLaw friction_law = FrictionLaw::saturated;
    double sliding_velocity = 1e-3;  ///< below it saturated friction fades to zero [m/s]
};

/// Read from a LIGGGHTS/LAMMPS data file or dump, Yade's text, a CSV (x_m,y_m,z_m,diameter_m) or a run.h5.
struct PackingFile {
    std::string path;
    std::optional<long> step = std::nullopt;  ///< or frame, as read_packing takes it
};

/// Drawn at random: truncated normal diameters, grown and relaxed without weight or friction.
struct GeneratedPacking {
    int count = 514;
    double diameter_mean = 21.490e-3;  ///< [m]
    double diameter_sd = 1.199e-3;     ///< [m]
    double diameter_min = 18.167e-3;   ///< [m]
    double diameter_max = 24.561e-3;   ///< [m]
    double packing_fraction = 0.59;    ///< fills the box up to the height that gives this
};

struct PackingSource {
    std::variant<PackingFile, GeneratedPacking> source = GeneratedPacking{};
    double position_jitter = 0;  ///< sd of a normal displacement of every coordinate [m]
    std::uint64_t seed = 1;      ///< of generation, jitter and which grain is of which species
    FractionsBy fractions_by = FractionsBy::number;
};

struct Plate {
    double start = 0.167643;  ///< highest position of its lower face [m]
    double end = 0.137517;    ///< lowest position [m]
    double speed = 0.1;       ///< at most [m/s]
};

struct Protocol {
    int cycles = 1;
    int discard = 0;            ///< first cycles left out of metrics
    int scans_per_stroke = 30;  ///< equally spaced; the last of each stroke at its end
    bool stop_at_scans = true;  ///< false: one continuous stroke, recorded in passing
    double rate_tolerance =
        0;  ///< largest estimated error of forces by the plate's speed; 0: always plate.speed
    double settle_unbalanced_force = 1e-3;  ///< a scan is taken when the net forces on grains fall below this
    double settle_time = 0.5;               ///< .. or, marked unsettled, after this long [s]
    double settle_drag =
        1e6;  ///< of velocities and spins while the plate stands still, at most half of both a step [1/s]
    double relax_time = 1.0;     ///< longest relaxation before the first stroke [s]
    bool scan_at_start = false;  ///< a scan, frame 0, of the relaxed packing before the first stroke
    double force_threshold = 0;  ///< contacts below it do not count in Z and <f> [N]
};

struct Numerics {
    double time_step = 0.1;   ///< fraction of the Rayleigh time of the smallest grain
    double skin = 0.2;        ///< neighbour list margin, over the mean radius
    double probe_gap = 0.15;  ///< gap up to which surfaces are probed, over the mean radius
    double overlap_limit =
        0.5;  ///< corrected overlap over the sum of radii beyond which no static solution is assumed
    bool stop_beyond_law = false;  ///< at the first scan beyond core/law_range.h
};

/// Effects that the plain model leaves out: each off, and at no cost, at its default.
struct Effects {
    double adhesion = 0;           ///< work of adhesion w of two grains [J/m2]
    double viscoelasticity = 0;    ///< part of the Hertz force that relaxes at constant overlap
    double relaxation_time = 0.1;  ///< of that part [s]
    double stiffening =
        0;  ///< c: Hertz force times 1 + c overlap / R*, or over 1 - c overlap / R* where c < 0
    double finite_strain =
        0;  ///< share of what hyperelastic_sphere adds to elastic_sphere; unused by other models
    double plasticity = 0;      ///< part of the largest overlap that stays after unloading
    double bulge_contacts = 1;  ///< part of the bulges that counts where grains do not overlap by themselves
    double friction_history = 0;    ///< share of the friction law that contact.friction_law does not name
    double rolling_resistance = 0;  ///< mu_r: resisting torque = mu_r R* F_n
    double modulus_scatter = 0;     ///< sd of ln E from grain to grain
    double diameter_error = 0;      ///< true less stated diameter, all grains alike [m]
    double polydispersity = 0;      ///< sd of true less stated diameter, grain by grain [m]
    double plate_tilt_x = 0;        ///< slope of the plate along x
    double plate_tilt_y = 0;        ///< .. along y
    double plate_compliance = 0;    ///< how far the plate gives way per newton [m/N]
};

/// Everything that one replica is made of.
struct Replica {
    std::string label;                              ///< what sets it apart, e.g. "mc_dem #3"
    std::map<std::string, std::string> parameters;  ///< every scene key and its value here, as text
    Box box{0.165191, 0.165834};
    GrainMaterial grains;          ///< of all, or what species say nothing of
    std::vector<Species> species;  ///< empty: one material
    std::vector<SpeciesPair> pairs;
    WallMaterial walls;
    ContactLaw contact;
    PackingSource packing;
    Plate plate;
    Protocol protocol;
    std::vector<Stage> programme;  ///< empty: the cycles of `protocol`
    Numerics numerics;
    Effects effects;
};

struct Output {
    bool positions = true;          ///< record positions at scans
    bool contacts = true;           ///< record contacts at scans
    double checkpoint_minutes = 1;  ///< wall-clock time between checkpoints
};

struct Scene {
    std::string name = "scene";
    std::string text;  ///< TOML with overrides applied: what a result file keeps
    Precision precision = Precision::single_precision;
    int slots = 16;  ///< neighbour slots per grain: 16, 32, 48 or 64
    Output output;
    std::vector<Replica> replicas;
};

}  // namespace mcdem::scene
