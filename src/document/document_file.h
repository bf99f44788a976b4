/* document_file.h - the document as one multi-part OpenEXR file.
   Layer 5.

   Part 0 "F": the composited heights, one float32 channel Y, so that every program that opens EXR sees
   the relief. Part 1 .. n: one a layer, float32, ZIP, named "layer:NAME" (then
   "layer:NAME (2)" where names repeat), the name itself in wrinkle:layer. Last, if the scene has a colour
   picture: part "colour", RGB float32. Attributes of part 0: wrinkle:version (of this format, "1"),
   wrinkle:program, wrinkle:scene (canonical command lines), wrinkle:wrap ("periodic", "clamp-u", ...),
   wrinkle:zero, wrinkle:range. */
#pragma once
#include "document/document.h"

#define WR_DOCUMENT_VERSION 1

/* "periodic", "clamp-u", "clamp-v" or "clamp": the word for the wrap of a table, as in commands. */
const char *wr_document_wrap_word(WrWrap wrap_u, WrWrap wrap_v);

/* Save as a whole replacement (base/file.h). scene_text: one canonical command a line. */
bool wr_document_save(const WrDocument *document, const char *scene_text, const char *path,
                      WrError *err);

typedef struct WrLoaded {
    WrDocument *document; /* the scene is the default one: run scene_text to restore it */
    char *scene_text;     /* owned, wr_free */
    WrImage *colour;      /* embedded colour picture or NULL; owned */
} WrLoaded;

/* True if the file is an EXR that carries our version attribute (false also for missing files). */
bool wr_document_recognise(const char *path);
/* A file from a newer version is an error that says so. Non-finite heights become 0 and are counted in
   *replaced. Only the layers are read; F is their sum. Outputs are untouched on failure. */
bool wr_document_load(const char *path, WrLoaded *out, int64_t *replaced, WrError *err);

/* Heights from any picture: grey, or Rec. 709 luma of the codes; NaN and infinity became 0 when it was
 * read (image->replaced counts them). The picture is resampled to width x height, each axis by itself: a
 * box filter when shrinking, Catmull-Rom when growing, taps beyond the edge wrapped on a periodic axis
 * and clamped on a clamped one; 0, 0 keeps its own size and exact values. The caller owns the result. */
WrField *wr_import_heights(const WrImage *image, int width, int height, WrWrap wrap_u,
                           WrWrap wrap_v, WrError *err);
