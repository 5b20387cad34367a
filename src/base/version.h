// The version that headers of outputs, --version and the package carry.
#pragma once

namespace varve {

/// "0.1.0".
const char* version();

}  // namespace varve
