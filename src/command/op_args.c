#include "command/op_args.h"

#include <string.h>

static WrArgSpec argument(const WrOpParam *param)
{
    WrArgSpec spec = { .name = param->name,
                       .type = WR_ARG_NUMBER,
                       .low = param->low,
                       .high = param->high,
                       .above = param->above,
                       .whole = param->whole,
                       .share = param->share,
                       .fallback = &param->fallback,
                       .unit = *param->unit ? param->unit : NULL,
                       .help = param->help };
    if (param->choices) {
        spec.type = WR_ARG_CHOICE;
        spec.words = param->choices;
        spec.fallback = NULL;
        spec.fallback_text = param->choices[(int)param->fallback];
    } else if (param->points) {
        spec.type = WR_ARG_LIST;
        spec.components = 2;
        spec.shape = "x,y;...";
        spec.rows_low = 2;
        spec.rows_high = WR_OP_POINTS;
        spec.fallback_rows = (int)*param->points;
        spec.fallback = param->points + 1;
    }
    return spec;
}

int wr_op_args(const WrOpInfo *op, WrArgSpec *out)
{
    const int count = wr_op_param_count(op);
    for (int k = 0; k < count; k++) out[k] = argument(&op->params[k]);
    return count;
}

WrFilter wr_call_filter(const WrCall *call, const WrOpInfo *op)
{
    WrFilter filter = { .op = op };
    for (int k = 0; k < wr_op_param_count(op); k++) {
        const WrArg *arg = wr_call_arg(call, op->params[k].name);
        if (op->params[k].choices) {
            filter.param[k] = arg->choice;
        } else if (op->params[k].points) {
            filter.param[k] = arg->rows;
            memcpy(filter.param + k + 1, arg->numbers, sizeof(double) * 2 * (size_t)arg->rows);
        } else {
            filter.param[k] = arg->numbers[0];
        }
    }
    return filter;
}
