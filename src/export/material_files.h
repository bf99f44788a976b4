/* material_files.h - material files of other programs for a set of maps: MaterialX, USD and glTF. A format is one
   row of wr_material_formats and one function. The files refer to the maps by their names, without a folder.

   Heights are displacements in the unit of the cell's size: millimetres (`cell mm=on`), else scene units. A texel x
   of 0..1 means bias + scale x with
     height        bias = h F0, scale = h (F1 - F0): F0, F1 heights of code 0 and the last code, h = wr_scene_relief
     displacement  bias = F0, scale = F1 - F0
     float files   bias = 0, scale = h (or 1)
   Other modules use the formats' names alone. */
#pragma once
#include "export/export.h"
#include "export/receipt.h"

#include <stdbool.h>

typedef struct WrDocument WrDocument;
typedef struct WrError WrError;
typedef struct WrText WrText;

/* A map as it was written. */
typedef struct WrMaterialMap {
    const WrExportKind *kind;
    const char *file; /* name without a folder; borrowed */
    WrExportOptions options;
    WrExportReport report;
} WrMaterialMap;

typedef struct WrMaterialRequest {
    const char *folder, *name; /* of the files, without endings */
    const WrDocument *document;
    const WrMaterialMap *maps; /* [count] */
    int count;
    WrReceipts *receipts; /* get one for each material file; NULL: not wanted */
} WrMaterialRequest;

typedef struct Material WrMaterialWork; /* private to material_files.c */

typedef struct WrMaterialFormat {
    const char *name; /* the ending of its files: "mtlx" */
    const char *title;
    /* Why the format cannot use the texture of a role; NULL: it can. */
    const char *(*refuses)(const WrMaterialWork *work, int role);
    /* Appends the file; and the bytes of NAME.bin beside it, if it has one. */
    bool (*write)(const WrMaterialWork *work, WrText *out, WrText *bin, WrError *err);
    /* Reads the file back, under its temporary path. */
    bool (*check)(const WrMaterialWork *work, const char *path, const WrText *out, WrError *err);
} WrMaterialFormat;
#define WR_MATERIAL_FORMATS 3
extern const WrMaterialFormat wr_material_formats[WR_MATERIAL_FORMATS];

/* Bits of the formats that a text names: "mtlx,gltf", "all" or "none". Errors: a word that is none of them. */
bool wr_material_formats_parse(const char *text, unsigned *formats, WrError *err);

/* Writes a file of each format, in the thread's file group. list: a line per file: its textures, and the maps that the
 * format cannot use with the reasons.
 * Errors   those of wr_file_write; a name that is not UTF-8, which these formats need */
bool wr_material_files_write(const WrMaterialRequest *order, unsigned formats, WrText *list,
                             WrError *err);
