/* mesh_solid.h - relief on an imported mesh as a solid.
   Private to this module. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrExportJob WrExportJob;
typedef struct WrSolidBody WrSolidBody;

/* The relief on the job's mesh; stores its error and other facts in the job's report. body: zero-initialised.
   Errors: no texture coordinates, too many triangles, cancelled, no memory. */
bool wr_mesh_solid_make(WrExportJob *job, WrSolidBody *body, WrError *err);
/* Fails because there are more triangles than there may be; guess: an error that may need fewer, or INFINITY. */
bool wr_export_solid_full(WrExportJob *job, double guess, WrError *err);
