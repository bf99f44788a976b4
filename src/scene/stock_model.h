/* stock_model.h - stock models: meshes that ship with the program (samples/models/), with their projection and first pose. */
#pragma once
#include "base/vec.h"

typedef struct WrStockModel {
    const char *name;  /* as in commands; its mesh is samples/models/NAME.ply */
    const char *title; /* in the window, English */
    const char *help;
    const char *projection; /* arguments of `surface mesh` */
    WrVec3 rotate_deg;      /* as `rotate` */
} WrStockModel;

#define WR_STOCK_MODELS 9
extern const WrStockModel wr_stock_models[WR_STOCK_MODELS];
