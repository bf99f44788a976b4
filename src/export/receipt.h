/* receipt.h - receipts of written files, for programs: one JSON object for each file. */
#pragma once
#include "base/array.h"
#include "export/export.h"

typedef struct WrReceipt {
    char *file;       /* path; owned in WrReceipts, else borrowed */
    const char *kind; /* "normal+y", "picture", "film", "document": lives as long as the program */
    WrExportReport report; /* of files that are no exports: size, channels and depth; unknown: 0 */
    double seconds;        /* from the begin of the work to the whole file */
} WrReceipt;

/* Receipts of files that are written together. */
typedef struct WrReceipts {
    WR_ARRAY(WrReceipt) files;
} WrReceipts;
/* Adds the receipt of a file that is written by now. report: NULL: unknown; began: wr_clock_seconds at the begin of the work. */
void wr_receipts_add(WrReceipts *receipts, const char *file, const char *kind,
                     const WrExportReport *report, double began);
void wr_receipts_free(WrReceipts *receipts);

/* Appends one line of JSON:

   {"file":...,"input":...,"kind":...,"width":...,"height":...,"channels":...,"depth":...,"range":[LOW,HIGH],
    "codes":[LOW,HIGH],"clipped":...,"triangles":...,"error":...,"unit":...,"sha256":...,"seconds":...}

   null is for values that the file does not have or that are unknown. range: of the table; codes: values of the first
   and the last code; error: the largest on reading back, of bodies the largest distance of a sample; unit: of range, codes and
   error: "height", the quantity's name, "degrees" or "mm". sha256: of the file's bytes, which are read for it.

   input  NULL: none     shown  name in place of receipt->file; NULL: that one
   Errors the file cannot be read */
bool wr_receipt_json(const WrReceipt *receipt, const char *input, const char *shown, WrText *text,
                     WrError *err);
