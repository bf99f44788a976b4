/* step_label.h - readable names of history steps: "Stroke, leaves, 43 samples". */
#pragma once

typedef struct WrText WrText;

/* Append the name of a command line in the window's language to out. */
void wr_step_label(const char *line, WrText *out);
/* A word of the command language in the window's language: by itself, else as a label ("raise" as "Raise"), else unchanged.
   Valid until the next call. */
const char *wr_step_word(const char *word);
