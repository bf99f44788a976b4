/* op_args.h - parameters of table operations as command arguments. Private to src/command. */
#pragma once
#include "command/command_line.h"
#include "field/ops.h"

/* Write one row for each parameter. Returns the number of rows. */
int wr_op_args(const WrOpInfo *op, WrArgSpec *out);
/* The operation with the parameter values of a call whose form has these arguments. */
WrFilter wr_call_filter(const WrCall *call, const WrOpInfo *op);
