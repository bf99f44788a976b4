/* accuracy_probe.h - probe of all quantities of the formulas at one point, and their text form. The work is
   WR_WORK_PROBE of accuracy_work.h. */
#pragma once
#include "ui/accuracy/accuracy_work.h"

#include "render/reference/reference.h"

#include <stdbool.h>

typedef struct WrText WrText;

/* Fill work->probe. False and work->err only for an invalid camera. */
bool wr_accuracy_probe(WrWork *work);

/* One row of the table: a name, one to three numbers, a unit, and a short description. */
typedef struct WrProbeRow {
    const char *name, *unit, *help;
    int count;
    double value[3];
} WrProbeRow;
#define WR_PROBE_ROWS 26
/* Rows of a probe that hit; footprint, level and intensity only if `seen`. Returns their number. */
int wr_accuracy_probe_rows(const WrProbe *probe, bool seen, WrProbeRow rows[WR_PROBE_ROWS]);
/* A number in the table's form, at most 10 characters. Returns text. */
char *wr_accuracy_probe_number(double value, char text[24]);
/* The whole probe as text, one row a line, with all digits. */
void wr_accuracy_probe_text(const WrProbe *probe, bool seen, WrText *text);
