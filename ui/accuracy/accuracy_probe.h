/* accuracy_probe.h - every quantity of the formulas at one place, and as lines for people.
   The work is WR_WORK_PROBE of accuracy_work.h. */
#pragma once
#include "ui/accuracy/accuracy_work.h"

#include "render/reference/reference.h"

#include <stdbool.h>

typedef struct WrText WrText;

/* Fill work->probe. False and work->err only for a camera that cannot look. */
bool wr_accuracy_probe(WrWork *work);

/* One row of the table: a name, one to three numbers, a unit, and what it is in a few words. */
typedef struct WrProbeRow {
    const char *name, *unit, *help;
    int count;
    double value[3];
} WrProbeRow;
#define WR_PROBE_ROWS 26
/* The rows of a probe that hit; footprint, level and intensity only where `seen`. Returns how many. */
int wr_accuracy_probe_rows(const WrProbe *probe, bool seen, WrProbeRow rows[WR_PROBE_ROWS]);
/* A number as the table shows it, at most 10 characters. Returns text. */
char *wr_accuracy_probe_number(double value, char text[24]);
/* All of it as text, a row a line, with all digits. */
void wr_accuracy_probe_text(const WrProbe *probe, bool seen, WrText *text);
