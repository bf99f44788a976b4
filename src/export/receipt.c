#include "export/receipt.h"

#include "base/error.h"
#include "base/hash.h"
#include "base/text.h"
#include "system/clock.h"

#include <math.h>

void wr_receipts_add(WrReceipts *receipts, const char *file, const char *kind,
                     const WrExportReport *report, double began)
{
    WrReceipt receipt = { .file = wr_strdup(file),
                          .kind = kind,
                          .seconds = wr_clock_seconds() - began };
    if (report) receipt.report = *report;
    wr_array_push(&receipts->files, receipt);
}

void wr_receipts_free(WrReceipts *receipts)
{
    for (int i = 0; i < receipts->files.count; i++) wr_free(receipts->files.data[i].file);
    wr_array_free(&receipts->files);
}

static void add_string(WrText *text, const char *name, const char *value)
{
    wr_text_addf(text, "%s\"%s\":", text->data[text->length - 1] == '{' ? "" : ",", name);
    if (value) wr_text_add_json_string(text, value);
    else wr_text_add(text, "null");
}

static void add_number(WrText *text, const char *name, bool known, double value)
{
    wr_text_addf(text, ",\"%s\":", name);
    wr_text_add_json_number(text, known ? value : NAN);
}

static void add_pair(WrText *text, const char *name, bool known, double low, double high)
{
    wr_text_addf(text, ",\"%s\":%s", name, known ? "[" : "null");
    if (!known) return;
    wr_text_add_json_number(text, low);
    wr_text_add(text, ",");
    wr_text_add_json_number(text, high);
    wr_text_add(text, "]");
}

bool wr_receipt_json(const WrReceipt *receipt, const char *input, const char *shown, WrText *text,
                     WrError *err)
{
    const WrExportReport *r = &receipt->report;
    const bool body = r->triangles > 0, map = r->width > 0 && r->depth > 0 && !body;
    const bool table = wr_export_find(receipt->kind) && map; /* else a picture of the scene */
    const bool values = table && r->channels == 1 && !r->lines;
    char sha256[65];
    if (!wr_sha256_file(receipt->file, sha256, err)) return false;
    wr_text_add(text, "{");
    add_string(text, "file", shown ? shown : receipt->file);
    add_string(text, "input", input);
    add_string(text, "kind", receipt->kind);
    add_number(text, "width", r->width > 0 && !body, r->width);
    add_number(text, "height", r->height > 0 && !body, r->height);
    add_number(text, "channels", map && r->channels > 0, r->channels);
    add_number(text, "depth", map, r->half ? 16 : r->depth);
    add_pair(text, "range", values, r->low, r->high);
    add_pair(text, "codes", table && r->ranged, r->code_low, r->code_high);
    add_number(text, "clipped", table, (double)r->clipped);
    add_number(text, "triangles", body, (double)r->triangles);
    add_number(text, "error", (body && !r->model) || (table && r->seen),
               body ? r->solid_error : r->worst);
    add_string(text, "unit",
               body                     ? (r->model ? NULL : "mm")
               : values                 ? (r->quantity ? r->quantity : "height")
               : table && r->convention ? "degrees"
                                        : NULL);
    add_string(text, "sha256", sha256);
    add_number(text, "seconds", true, rint(receipt->seconds * 1e6) / 1e6);
    wr_text_add(text, "}\n");
    return true;
}
