// What the files of --rerender hold.
#pragma once

#include "help.h"

namespace varve::cli {

Topic rerender_topic();

}  // namespace varve::cli
