/* Arguments of the commands that go through what was done. */
#include "command/args.h"

#define STEPS(help_)                                                                               \
    {                                                                                              \
        .name = "N", .type = WR_ARG_NUMBER, .positional = true, .whole = true, .low = 1,           \
        .high = 1e9, .fallback = NUMBERS(1), .help = help_                                         \
    }

const WrArgSpec wr_args_undo[] = { STEPS("how many steps back"), { 0 } };
const WrArgSpec wr_args_redo[] = { STEPS("how many steps forward"), { 0 } };

static const WrForm view_forms[] = {
    { .name = "back",
      .help = "to views before this one",
      .args = { STEPS("how many views back") } },
    { .name = "forward",
      .help = "to those that were gone back from",
      .args = { STEPS("how many views forward") } },
};

bool wr_form_view(int i, WrForm *out)
{
    if (i >= (int)(sizeof view_forms / sizeof *view_forms)) return false;
    *out = view_forms[i];
    return true;
}

const WrArgSpec wr_args_history[] = {
    { .name = "budget",
      .type = WR_ARG_NUMBER,
      .whole = true,
      .low = 0,
      .high = 1e15,
      .unit = "bytes",
      .help = "memory that old states may take; left out, it stays (at first 1 GiB)" },
    { 0 }
};

const WrArgSpec wr_args_script[] = {
    { PLACE("FILE"), .type = WR_ARG_PATH, .help = "a script, *.wrinkle" }, { 0 }
};
