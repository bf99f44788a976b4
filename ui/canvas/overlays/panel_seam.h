/* panel_seam.h - seam meter: continuity of the table across the cell's edges, measured on a thread of its own. */
#pragma once
#include "ui/app/state/app_state.h"

typedef struct WrCertificate WrCertificate;

void wr_panel_seam_meter(WrApp *app); /* on the canvas; empty until the first table is measured */
/* The newest measurement, of this table or one before; NULL: none yet. */
const WrCertificate *wr_seam_meter_certificate(const WrApp *app);
void wr_seam_meter_free(WrApp *app);

extern const WrPart wr_part_seam_meter;
