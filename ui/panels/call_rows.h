/* call_rows.h - rows for the arguments of a command line, by the command table; for generators with the labels and slider ranges
   of their parameters. */
#pragma once
#include "ui/toolkit/gui.h"

#include <stdbool.h>

typedef struct WrCall WrCall;
typedef struct WrText WrText;

/* Draws a row for each argument that has a value, and a fold with those that have none; checksums and long lists of points
   have none. The call takes the changed value, and forgets its checksums. DONE, LIVE: a value changed, or is being
   dragged. */
WrEdit wr_call_rows(WrCall *call);
/* Appends the words that change `from` into `call`, both of the same command and form, as wr_call_change reads them; nothing if they
   are equal. */
void wr_call_difference(const WrCall *from, const WrCall *call, WrText *words);
