// consumer PNG: prints the version and writes a picture, so that headers, archive, dependencies and module are all
// used.
#include <cstdio>

#include "base/error.h"
#include "exr/pictures.h"
#include "resolve_sequence.h"

int main(int, char** argv) {
  std::printf("varve %s\n", varve::version());
  const varve::ResolveJob job;
  if (job.parameters.recursive.alpha <= 0) return 1;
  try {
    varve::write_map_png(argv[1], varve::Plane<float>(varve::Window{0, 0, 4, 4}, 0, 0.5f), "viridis", 0, 1);
  } catch (const varve::Failure& failure) {
    std::printf("%s\n", failure.what());
    return int(failure.code());
  }
  return 0;
}
