/* sidecar.h - raw number files, described by a JSON sidecar ("h.r16", "h.r16.json"). */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrImageRows WrImageRows;
typedef struct WrImageRequest WrImageRequest;
typedef struct WrText WrText;

/* True for the extensions of raw files: raw, r16, r32. */
bool wr_is_raw_path(const char *path);
/* True if the file has a sidecar. */
bool wr_sidecar_is_there(const char *path);
/* Path of the sidecar. */
void wr_sidecar_name(const char *path, WrText *name);

/* Reads a raw file as an image, described by its sidecar:
 *
 *   width, height, channels (1..4, default 1)   type: u8, u16, f16, f32   endian: little (default), big
 *   sha256: of the file (default: any)   labels: texts by name, "wrinkle:range" and so on
 *
 * Other members are ignored. Errors: no sidecar; it or the file is invalid. */
WrImageRows *wr_sidecar_rows(const char *path, const WrImageRequest *wish, WrError *err);
