/* preset_overrides.h - text form "name=value;name=value" of a preset's changed settings and curves. No window
   needed. */
#pragma once
#include <stdbool.h>

typedef struct WrText WrText;

/* The value of a name; false if it is missing in the text (which may be NULL). */
bool wr_tuning_get(const char *set, const char *name, double *value);
/* The text with that value added or replaced; order is kept; NAN removes the name. */
void wr_tuning_put(const char *set, const char *name, double value, WrText *out);
/* The text with a value that is not a number added or replaced; NULL removes the name. */
void wr_tuning_put_text(const char *set, const char *name, const char *value, WrText *out);
/* True if the name has a value in the text. set may be NULL. */
bool wr_tuning_has(const char *set, const char *name);
/* Number of pairs. */
int wr_tuning_count(const char *set);
