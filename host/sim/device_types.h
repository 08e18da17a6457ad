// Structs shared by host and device, once for each precision of the kernels.
#pragma once

namespace mcdem::inline sim {
namespace f32 {
using real = float;
#include "kernels/material.h"
#include "kernels/replica.h"
#include "kernels/report.h"
}  // namespace f32
namespace f64 {
using real = double;
#include "kernels/material.h"
#include "kernels/replica.h"
#include "kernels/report.h"
}  // namespace f64
#include "kernels/block.h"
#include "kernels/partner.h"
#include "kernels/status.h"
}  // namespace mcdem::sim
