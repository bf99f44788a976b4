/* preset_overrides.h - the text "name=value;name=value" of a preset's changed settings and curves. No window needed. */
#pragma once
#include <stdbool.h>

typedef struct WrText WrText;

/* The value of a name; false if it is not in the text (which may be NULL). */
bool wr_tuning_get(const char *set, const char *name, double *value);
/* The text with that value, in the order in which they came; NAN takes the name out. */
void wr_tuning_put(const char *set, const char *name, double value, WrText *out);
/* The same for a value that is no number; NULL takes the name out. */
void wr_tuning_put_text(const char *set, const char *name, const char *value, WrText *out);
/* Is it among them, with whatever value? set may be NULL. */
bool wr_tuning_has(const char *set, const char *name);
/* How many there are. */
int wr_tuning_count(const char *set);
