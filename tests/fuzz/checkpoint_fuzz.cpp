// Any content in a checkpoint whose hash is right: restored, or refused with a message.

#include "bodies/model.hpp"
#include "core/errors.hpp"
#include "dynamics/simulation.hpp"
#include "fuzz/fuzz_input.hpp"
#include "input/read_scene.hpp"
#include "results/recorder.hpp"
#include "run/checkpoint.hpp"
#include "scene/scene.hpp"
#include "setup/build_model.hpp"

namespace {

using namespace pliant;

constexpr const char* scene_text = R"(
[time]
end = 1
[materials.soft]
law = "neo-hookean"
density = 1
young = 1
poisson = 0.3
[shapes.disc]
kind = "disc"
diameter = 2
nodes = 24
[[grains]]
name = "disc"
shape = "disc"
body = "compliant"
material = "soft"
packing = { kind = "positions", positions = [[0, 0], [2.1, 0]] }
[[contacts]]
between = "all"
law = "cohesive"
strength = 0.1
[[probes]]
name = "energy"
quantity = "energy"
period = 0.1
)";

/// The scene, and the folder that its run left, with its checkpoint.
struct Left {
  std::filesystem::path folder = fuzz::scratch_folder() / "out";
  Model model;
  std::string header;

  Left() {
    const std::filesystem::path file = fuzz::scratch_folder() / "scene.toml";
    fuzz::write_text(file, scene_text);
    model = build_model(read_scene(file));
    std::filesystem::create_directories(folder);
    Simulation simulation(model);
    Recorder recorder(model, folder, true, Opening::create);
    write_checkpoint(folder, scene_text, simulation, recorder, simulation.state().time);
    const CheckpointText written = read_checkpoint_file(folder / "checkpoint.bin");
    header = written.header();
    if (const char* seeds = std::getenv("PLIANT_FUZZ_SEEDS")) {
      fuzz::write_text(std::filesystem::path(seeds) / "file", std::string(1, '\0') + written.bytes);
      fuzz::write_text(std::filesystem::path(seeds) / "content", std::string(1, '\1').append(written.content()));
    }
  }
};

const Left& left() {
  static const Left once;
  return once;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  left();  // so that its seeds are there before the fuzzer looks
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  fuzz::Input input(bytes, count);
  const bool whole = input.byte() % 4 == 0;  // the file as it is, or only its content
  const std::filesystem::path file = left().folder / "checkpoint.bin";
  if (whole) {
    fuzz::write_text(file, input.rest());
  } else {
    CheckpointFile written(file, left().header);
    written.append(input.rest().data(), input.rest().size());
    written.commit();
  }
  try {
    const Checkpoint checkpoint(left().folder);
    Simulation simulation(left().model);
    Recorder recorder(left().model, left().folder, true, Opening::resume);
    checkpoint.restore(simulation, recorder);
  } catch (const OutputError&) {
  }
  return 0;
}
