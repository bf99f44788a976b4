#include "ui/app/app.h"

extern const WrWindowModule wr_window_table;
const WrWindowModule wr_window_table = { WR_WINDOW_VERSION, wr_app_run };
