// A tiny scene drawn at random: models, effects, sizes, precision, slots, friction laws.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "core/names.h"

namespace mcdem {

class RandomScene {
public:
    explicit RandomScene(unsigned seed) : engine_(seed) {}

    /// As TOML. Replicas differ in model, and some in grains or an effect as well.
    std::string text() {
        draw_packing();
        draw_materials();
        draw_effects();
        text_ += fmt::format(
            "[protocol]\nscans_per_stroke = {}\nstop_at_scans = {}\nrelax_time = 0.01\nsettle_time = 0.01\n",
            whole(1, 3), chance(0.7));
        text_ += fmt::format(
            "[numerics]\nslots = {}\nprecision = \"{}\"\nskin = {}\nprobe_gap = {}\ntime_step = {}\n",
            chance(0.6) ? 16 : 32, chance(0.5) ? "float" : "double", between(0.05, 0.4), between(0.1, 0.4),
            between(0.03, 0.15));
        draw_variations();
        if (chance(0.4)) draw_species();
        return text_;
    }

private:
    double between(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
    }
    int whole(int low, int high) {
        return low + static_cast<int>(engine_() % static_cast<unsigned>(high - low + 1));
    }
    bool chance(double part) { return between(0, 1) < part; }
    double of_any_size(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }

    void draw_packing() {
        count_ = static_cast<int>(of_any_size(1, 120));
        const double mean = of_any_size(1e-3, 0.05), widest = 1.2 * mean;
        double height = between(1.6, 4) * widest, fraction = between(0.2, 0.6);
        const double grains = count_ * std::numbers::pi / 6 * mean * mean * mean;
        double width = 0;
        while ((width = std::sqrt(grains / (fraction * height))) < 1.1 * widest) {
            height = std::max(1.6 * widest, 0.8 * height);
            fraction *= 0.8;
        }
        const double start = 1.05 * height;
        text_ +=
            fmt::format("[box]\nsize_x = {0}\nsize_y = {1}\n[plate]\nstart = {2}\nend = {3}\nspeed = {4}\n",
                        width, width, start, start - between(0.1, 0.4) * mean, between(2, 10) * mean);
        text_ += fmt::format(
            "[packing]\ndiameter_mean = {}\ndiameter_sd = {}\ndiameter_min = {}\ndiameter_max = "
            "{}\n"
            "packing_fraction = {}\nseed = {}\n",
            mean, chance(0.3) ? 0 : 0.06 * mean, 0.8 * mean, widest, fraction, whole(0, 1000));
        mean_ = mean;
    }

    void draw_materials() {
        text_ += fmt::format(
            "[grains]\nyoungs_modulus = {}\npoisson_ratio = {}\ndensity = {}\nexcess_density = {}\nfriction "
            "= {}\n"
            "restitution = {}\ndrag = {}\n",
            of_any_size(5e3, 1e5), between(0, 0.5), of_any_size(5, 50), chance(0.2) ? -2 : between(0, 10),
            between(0, 0.6), between(0.2, 1), chance(0.5) ? 0 : between(0, 20));
        text_ +=
            fmt::format("[walls]\nyoungs_modulus = {}\npoisson_ratio = {}\nfriction = {}\nrestitution = {}\n",
                        of_any_size(1e5, 1e8), between(0, 0.5), between(0, 0.6), between(0.2, 1));
        text_ += fmt::format("[contact]\ngamma = {}\nfriction_law = \"{}\"\n", between(0.5, 1.3),
                             chance(0.5) ? "mindlin" : "saturated");
    }

    void draw_species() {
        const int species = whole(1, std::min(3, count_));
        for (int s = 1; s <= species; ++s) {
            text_ += fmt::format("[[species]]\nname = \"s{}\"\n", s);
            const auto maybe = [&](const char* key, double value) {
                if (chance(0.5)) text_ += fmt::format("{} = {}\n", key, value);
            };
            maybe("youngs_modulus", of_any_size(5e3, 1e5));
            maybe("poisson_ratio", between(0, 0.5));
            maybe("density", of_any_size(5, 50));
            maybe("friction", between(0, 0.6));
            maybe("restitution", between(0.2, 1));
        }
        if (species > 1 && chance(0.5))
            text_ += fmt::format("[[pair]]\nfirst = \"s1\"\nsecond = \"{}\"\nfriction = {}\n",
                                 chance(0.5) ? "s2" : "walls", between(0, 0.6));
    }

    void draw_effects() {
        text_ += "[effects]\n";
        const auto maybe = [&](const char* key, double amplitude) {
            if (chance(0.25)) text_ += fmt::format("{} = {}\n", key, amplitude);
        };
        maybe("adhesion", between(0, 0.02));
        maybe("viscoelasticity", between(0, 0.6));
        maybe("stiffening", between(-1, 1));
        maybe("finite_strain", between(0, 1));
        maybe("plasticity", between(0, 0.4));
        maybe("bulge_contacts", between(0, 1));
        maybe("friction_history", between(0, 1));
        maybe("rolling_resistance", between(0, 0.3));
        maybe("modulus_scatter", between(0, 0.4));
        maybe("diameter_error", between(-0.02, 0.02) * mean_);
        maybe("polydispersity", between(0, 0.03) * mean_);
        maybe("plate_tilt_x", between(-0.05, 0.05));
        maybe("plate_tilt_y", between(-0.05, 0.05));
        maybe("plate_compliance", between(0, 1e-3));
    }

    void draw_variations() {
        std::vector<ContactModel> models;
        for (const auto model :
             {ContactModel::independent, ContactModel::point_force_on_sphere, ContactModel::sphere_to_sphere,
              ContactModel::elastic_half_space, ContactModel::mc_dem, ContactModel::elastic_sphere,
              ContactModel::hyperelastic_sphere})
            models.push_back(model);
        std::shuffle(models.begin(), models.end(), engine_);
        text_ += fmt::format("[batch.vary]\n\"contact.model\" = [\"{}\", \"{}\"]\n", name(models[0]),
                             name(models[1]));
        const int fewer = chance(0.5) ? count_ : (4 * count_ + 4) / 5;
        text_ += fmt::format("\"packing.count\" = [{}{}]\n", count_,
                             fewer < count_ ? fmt::format(", {}", fewer) : "");
    }

    std::mt19937_64 engine_;
    std::string text_;
    int count_ = 0;
    double mean_ = 0;  ///< diameter [m]
};

}  // namespace mcdem
