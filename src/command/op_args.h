/* op_args.h - the parameters of table operations as arguments of commands.
   Layer 6, private to src/command. */
#pragma once
#include "command/command_line.h"
#include "field/ops.h"

/* One argument a parameter. Returns how many. */
int wr_op_args(const WrOpInfo *op, WrArgSpec *out);
/* The operation with the values of a call whose form has these arguments. */
WrFilter wr_call_filter(const WrCall *call, const WrOpInfo *op);
