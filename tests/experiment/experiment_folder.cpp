#include "experiment/experiment_folder.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>

namespace mcdem::test {

ExperimentFolder::ExperimentFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "mcdem-test-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
    path_ = pattern;
    texts_["experiment.toml"] = R"(name = "two grains"
[box]
size = [0.04, 0.03]
[grains]
youngs_modulus = 23300.0
poisson_ratio = 0.5
friction = 0.03
[walls]
youngs_modulus = 50e6
[uncertainty]
youngs_modulus = 500.0
walls.youngs_modulus = 1e6
[measurement]
position_error = 1e-4
force_threshold = 0.005
)";
    texts_["plate.csv"] = R"(frame,cycle,phase,plate_z_m,top_force_N
0,0,load,0.022,0
1,0,load,0.019,0.4
2,0,unload,0.021,0.01
)";
    texts_["grains.csv"] = R"(frame,grain,x_m,y_m,z_m,diameter_m
0,0,0.01,0.015,0.01,0.02
0,1,0.03,0.015,0.01,0.02
1,0,0.0095,0.015,0.0095,0.02
1,1,0.0305,0.015,0.0095,0.02
)";
    texts_["contacts.csv"] = R"(frame,grain,partner,x_m,y_m,z_m,fx_N,fy_N,fz_N
1,1,0,0.02,0.015,0.0095,0.03,0,0.04
1,0,floor,0.0095,0.015,0,0,0,0.2
1,1,floor,0.0305,0.015,0,0,0,0.3
1,0,plate,0.0095,0.015,0.019,0,0,-0.2
1,0,x_min,0,0.015,0.0095,0.004,0,0
)";
}

ExperimentFolder::~ExperimentFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

void ExperimentFolder::replace(const std::string& name, const std::string& from, const std::string& to) {
    std::string& text = texts_[name];
    const auto place = text.find(from);
    ASSERT_NE(place, std::string::npos) << name << " holds no " << from;
    text.replace(place, from.size(), to);
}

void ExperimentFolder::write() const {
    for (const auto& entry : std::filesystem::directory_iterator(path_))
        std::filesystem::remove_all(entry.path());
    for (const auto& [name, text] : texts_) std::ofstream(path_ / name, std::ios::binary) << text;
}

Experiment ExperimentFolder::read() {
    write();
    return read_experiment(path_);
}

std::string ExperimentFolder::error() {
    write();
    return error_as_it_lies();
}

std::string ExperimentFolder::error_as_it_lies(std::uintmax_t largest) const {
    try {
        read_experiment(path_, largest);
        return "no error";
    } catch (const InputError& error) {
        std::string message = error.what();
        const std::string prefix = path_.string() + "/";
        for (auto at = message.find(prefix); at != std::string::npos; at = message.find(prefix))
            message.erase(at, prefix.size());
        return message;
    }
}

}  // namespace mcdem::test
