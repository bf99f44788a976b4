/* guide_run.h - commands of the guide's pages that run in the window: which lines of code are commands, and a sentence that
   says what a line would change. */
#pragma once
#include "ui/state/app_state.h"

#include <stdbool.h>

typedef struct WrText WrText;

/* Whether a line of code is a command of the language; lines for a shell are not. */
bool wr_guide_is_command(const char *line);
/* What a command would do to the document or the disk, in the window's language; added to out. */
void wr_guide_effect(const WrApp *app, const char *line, WrText *out);
