/* atlas.h - texture atlas: several cells side by side in one table, each with a margin that continues it.
   Private to this module. */
#pragma once
typedef struct WrError WrError;
typedef struct WrExportJob WrExportJob;
typedef struct WrField WrField;

/* Arranges the job's own table and those of the files named in its options, in this order, row by row in a
   nearly square grid. Their positions go into the job's label "wrinkle:atlas", "x,y,width,height;...". Margins
   repeat the continuation beyond a cell's edges. Errors: a file without heights; more than WR_FIELD_MAX texels;
   no memory. */
WrField *wr_export_atlas(WrExportJob *job, const WrField *own, WrError *err);
