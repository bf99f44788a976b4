/* cell_layout.h - cells laid out before they are exported: repeats, half-drop and brick, a hexagonal lattice as a rectangle,
   several cells in an atlas, another number of texels.
   Layer 6. Private to this room. */
#pragma once
#include "field/certificate.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrExportJob WrExportJob;
typedef struct WrField WrField;
typedef struct WrText WrText;

/* The table that the job's options lay out of its own, the size of its cell in the options, the copies in the job; a formula's heights are
 * sampled into it. NULL where nothing is to be laid out, and *good stays; NULL and an error where it cannot. */
WrField *wr_export_sheet(WrExportJob *job, bool *good, WrError *err);

/* How the edges of the job's cell meet, as it is laid. */
WrCertificate wr_export_certify(const WrExportJob *job);

/* A table of half the size, rounded down, at least 1: means of what its texels cover. */
WrField *wr_export_half(const WrExportJob *job, const WrField *field, WrError *err);
/* "a.png" of level 2: "a_2.png". */
void wr_export_level_name(const char *path, int level, WrText *name);
