// Common part of the OpenCL layers (cl_layer.h, loaded through OPENCL_LAYERS): the functions of the device
// below, and the two functions by which the loader initialises a layer. Each layer is one source file that
// includes this one.
#pragma once
#define CL_TARGET_OPENCL_VERSION 300
#include <CL/cl_layer.h>

#include <cstring>

namespace {

cl_icd_dispatch below, layer;

/// Puts the layer's own functions into `layer`; called once.
void take_over();

}  // namespace

extern "C" {

cl_int CL_API_CALL clGetLayerInfo(cl_layer_info name, size_t size, void* value, size_t* size_used) {
    const cl_layer_api_version version = CL_LAYER_API_VERSION_100;
    if (name != CL_LAYER_API_VERSION || (value && size < sizeof version)) return CL_INVALID_VALUE;
    if (value) std::memcpy(value, &version, sizeof version);
    if (size_used) *size_used = sizeof version;
    return CL_SUCCESS;
}

cl_int CL_API_CALL clInitLayer(cl_uint entries, const cl_icd_dispatch* target, cl_uint* entries_used,
                               const cl_icd_dispatch** dispatch) {
    constexpr auto known = sizeof(cl_icd_dispatch) / sizeof(target->clGetPlatformIDs);
    if (entries < known) return CL_INVALID_VALUE;
    below = layer = *target;
    take_over();
    *entries_used = known;
    *dispatch = &layer;
    return CL_SUCCESS;
}
}
