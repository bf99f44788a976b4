#include "generate/param.h"

#include "base/error.h"

#include <math.h>
#include <string.h>

const WrParamValue *wr_param_value(const WrParams *params, const char *name)
{
    int i = 0;
    while (params->params[i].name && strcmp(params->params[i].name, name) != 0) i++;
    WR_ASSERT(params->params[i].name);
    return &params->values[i];
}

double wr_param_number(const WrParams *params, const char *name)
{
    return wr_param_value(params, name)->number[0];
}

int wr_param_whole(const WrParams *params, const char *name)
{
    return (int)wr_param_number(params, name);
}

uint32_t wr_param_seed(const WrParams *params)
{
    return (uint32_t)wr_param_number(params, "seed");
}

WrOrigin wr_origin(int size, double origin)
{
    double moved = (origin - floor(origin)) * size, whole = floor(moved + 0.5);
    return (WrOrigin){ .size = size, .shift = (int)whole % size, .rest = moved - whole };
}
