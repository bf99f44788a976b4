/* cell_layout.h - arrangement of cells before export: repetition, half-drop and brick, a hexagonal lattice as a
   rectangle, an atlas, resizing.
   Private to this module. */
#pragma once
#include "field/seam_check.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrExportJob WrExportJob;
typedef struct WrField WrField;
typedef struct WrText WrText;

/* Builds the table that the job's options request; stores the cell's size in the options and the copies in the
   job. A formula's heights are sampled into it. NULL with *good unchanged if nothing is requested; NULL and an
   error on failure. */
WrField *wr_export_build_table(WrExportJob *job, bool *good, WrError *err);

/* Seam continuity of the job's cell in its arrangement. */
WrCertificate wr_export_certify_seam(const WrExportJob *job);

/* A table of half the size, rounded down, at least 1: means of the covered texels. */
WrField *wr_export_half(const WrExportJob *job, const WrField *field, WrError *err);
/* File name of a level: "a.png", level 2: "a_2.png". */
void wr_export_level_name(const char *path, int level, WrText *name);
