/* sidecar.h - files of nothing but numbers, and the JSON beside each that says what they are ("h.r16", "h.r16.json"). */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrImageRows WrImageRows;
typedef struct WrImageWish WrImageWish;
typedef struct WrText WrText;

/* Whether the ending says that there are numbers alone: raw, r16, r32. */
bool wr_sidecar_takes(const char *path);
/* Whether there is a sidecar beside it. */
bool wr_sidecar_is_there(const char *path);
/* Its name. */
void wr_sidecar_name(const char *path, WrText *name);

/* The picture that a file of numbers is, by its sidecar:
 *   width, height, channels (1..4, left out: 1)   type: u8, u16, f16, f32   endian: little (left out), big
 *   sha256: of the file (left out: any)   labels: texts by their names, "wrinkle:range" and so on
 * Nothing else in it is looked at. Errors: no sidecar; it or the file is not what it should be. */
WrImageRows *wr_sidecar_rows(const char *path, const WrImageWish *wish, WrError *err);
