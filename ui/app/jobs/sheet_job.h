/* sheet_job.h - background work of the export sheet: pictures of all maps, and their files. The document is a
   snapshot, so that painting can continue. */
#pragma once
#include "ui/app/jobs/job.h"

#include "base/error.h"
#include "base/text.h"
#include "export/preview.h"
#include "export/map_sets.h"
#include "scene/export_settings.h"

#include <stdbool.h>

typedef struct WrDocument WrDocument;

#define WR_SHEET_PICTURE 96 /* largest size of a picture's longer side, texels */

/* Change w x h to the requested export size. */
void wr_sheet_size(int size, int *w, int *h);
/* Bits per channel of the map. */
int wr_sheet_depth(const WrMapSetEntry *map);

typedef struct WrSheetLook {
    WrDocument *document; /* owned */
    WrSheetRequest ask;
    WrMapSet *set; /* owned; NULL: err */
    WrExportPreview pictures[WR_MAP_SET_ENTRIES_MAX];
    WrHistogram histogram;
    WrCertificate seam;
    int width, height; /* size of the files */
    double bytes;      /* approximate upper limit for all files */
    WrError err;
} WrSheetLook;

typedef struct WrSheetWrite {
    WrDocument *document; /* owned */
    WrSheetRequest ask;
    const char *material; /* "material=all": a word of `maps`, static; NULL: as the set has it */
    WrText report;        /* one line per file */
    int files;
    double seconds;
    bool ok, cancelled;
    WrError err;
} WrSheetWrite;

/* Job kinds; they own the document. */
extern const WrJobKind wr_sheet_look_kind, wr_sheet_write_kind;
WrSheetLook *wr_sheet_look_new(WrDocument *document, const WrSheetRequest *ask);
void wr_sheet_look_free(WrSheetLook *look); /* NULL is allowed */
WrSheetWrite *wr_sheet_write_work_new(WrDocument *document, const WrSheetRequest *ask,
                                      const char *material);
void wr_sheet_write_free(WrSheetWrite *write);
