/* sheet_job.h - what the export sheet has done in the background: pictures of all maps, and all files of them.
   The document is a snapshot, so that painting goes on meanwhile. */
#pragma once
#include "ui/jobs/job.h"

#include "base/error.h"
#include "base/text.h"
#include "export/picture.h"
#include "export/map_sets.h"
#include "scene/export_settings.h"

#include <stdbool.h>

typedef struct WrDocument WrDocument;

#define WR_SHEET_PICTURE 96 /* texels of a picture's longer side, at most */

/* The maps that come of it: the set with its depth and range, a kind as a set of one. The caller's; NULL. */
WrSet *wr_sheet_set(const WrSheetAsk *ask, WrError *err);
/* Texels of a table of w x h. */
void wr_sheet_size(int size, int *w, int *h);
/* Bits a number of that map. */
int wr_sheet_depth(const WrSetMap *map);

typedef struct WrSheetLook {
    WrDocument *document; /* owned */
    WrSheetAsk ask;
    WrSet *set; /* owned; NULL: err */
    WrExportPicture pictures[WR_SET_MAPS];
    WrHistogram histogram;
    WrCertificate seam;
    int width, height; /* of the files */
    double bytes;      /* of all files, at most, about */
    WrError err;
} WrSheetLook;

typedef struct WrSheetWrite {
    WrDocument *document; /* owned */
    WrSheetAsk ask;
    WrText told; /* a line a file */
    int files;
    double seconds;
    bool ok, cancelled;
    WrError err;
} WrSheetWrite;

/* Works for jobs of these kinds; take the document. */
extern const WrJobKind wr_sheet_look_kind, wr_sheet_write_kind;
WrSheetLook *wr_sheet_look_new(WrDocument *document, const WrSheetAsk *ask);
void wr_sheet_look_free(WrSheetLook *look); /* NULL is fine */
WrSheetWrite *wr_sheet_write_new(WrDocument *document, const WrSheetAsk *ask);
void wr_sheet_write_free(WrSheetWrite *write);
