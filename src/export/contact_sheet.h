/* contact_sheet.h - a contact sheet: maps as small pictures side by side, each with its name below.
   Layer 6. Private to this room. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrExportOptions WrExportOptions;
typedef struct WrExportPicture WrExportPicture;

typedef struct WrContact WrContact;

/* Of that many maps, each in a square of `tile` pixels. NULL and an error: the file's format cannot hold it, or no
 * memory. The caller owns it. */
WrContact *wr_contact_new(const char *path, int count, int tile, WrError *err);
void wr_contact_free(WrContact *contact); /* NULL is fine */
/* The next map: as large as it fits, means of its texels where it is larger. No words where no typeface is installed. */
void wr_contact_add(WrContact *contact, const char *name, const WrExportPicture *picture);
/* Write the file as a whole replacement. */
bool wr_contact_write(WrContact *contact, WrError *err);
/* Of the whole sheet, in pixels. */
void wr_contact_size(const WrContact *contact, int *width, int *height);

/* The options of the kind. */
bool wr_export_set_contact_maps(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_contact_tile(WrExportOptions *options, const char *value, WrError *err);

#define WR_CONTACT_TILE 256
