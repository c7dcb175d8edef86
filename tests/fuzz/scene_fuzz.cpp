// Any text as a scene: read, or refused with a message.

#include "core/errors.hpp"
#include "fuzz/fuzz_input.hpp"
#include "input/read_scene.hpp"
#include "scene/scene.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  using namespace pliant;
  const std::filesystem::path file = fuzz::scratch_folder() / "scene.toml";
  fuzz::write_text(file, {reinterpret_cast<const char*>(bytes), count});
  try {
    read_scene(file);
  } catch (const InputError& error) {
    fuzz::require(std::string_view(error.what()).size() > 10, "an error says something");
  }
  return 0;
}
