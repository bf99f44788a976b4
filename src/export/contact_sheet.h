/* contact_sheet.h - contact sheet: maps as thumbnails in a grid, each with its name below. Private to this
   module. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrExportOptions WrExportOptions;
typedef struct WrExportPreview WrExportPreview;

typedef struct WrContact WrContact;

/* Creates a sheet of `count` maps, each in a square of `tile` pixels. NULL and an error: the file's format does
   not support it, or no memory. The caller owns it. */
WrContact *wr_contact_new(const char *path, int count, int tile, WrError *err);
void wr_contact_free(WrContact *contact); /* NULL is fine */
/* Adds the next map, averaged if it is larger than its tile. Names are omitted if no font is installed. */
void wr_contact_add(WrContact *contact, const char *name, const WrExportPreview *picture);
/* Writes the file atomically. */
bool wr_contact_write(WrContact *contact, WrError *err);

/* Option parsers of the kind. */
bool wr_export_parse_contact_maps(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_contact_tile(WrExportOptions *options, const char *value, WrError *err);

#define WR_CONTACT_TILE 256
