// A program of another project that embeds the engine: `outside SCENE FOLDER` runs a scene and prints the
// results.
#include <mcdem/ensemble/run_scene.h>
#include <mcdem/io/results.h>
#include <mcdem/scene/read/read_scene.h>

#include <cstdio>

int main(int, char** arguments) {
    const mcdem::Scene scene = mcdem::read_scene(arguments[1]);
    mcdem::Device device;
    mcdem::RunOptions options;
    options.folder = arguments[2];
    mcdem::run_scene(device, scene, options);
    for (const mcdem::Recording& recording : mcdem::read_run(arguments[2]).recordings)
        std::printf("%s: %zu scans\n", recording.label.c_str(), recording.scans.size());
}
