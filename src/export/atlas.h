/* atlas.h - several cells side by side in one table, each in a margin of its own continuation.
   Layer 6. Private to this room. */
#pragma once
typedef struct WrError WrError;
typedef struct WrExportJob WrExportJob;
typedef struct WrField WrField;

/* The job's own table and those of the files that its options name, in their order, by rows of a grid as nearly square
 * as may be; where each stands goes into the job's label "wrinkle:atlas", "x,y,width,height;...". Margins repeat what lies
 * beyond a cell's edges. Errors: a file that is no heights; more than WR_FIELD_MAX texels; no memory. */
WrField *wr_export_atlas(WrExportJob *job, const WrField *own, WrError *err);
