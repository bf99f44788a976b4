# Maps and models of many documents, made by make: only those that are older than their document, and as many at a
# time as -j says. Another machine that sees the same folders can make another set at the same time.
#
#   make -f maps.mk -j 8 [IN=FOLDER] [OUT=FOLDER] [SETS='unreal blender'] [WRINKLE=PROGRAM]
#
# IN    the folder of the scripts (.)
# OUT   the folder that has a folder for each set, and `bodies` (maps)
# SETS  which sets: `wrinkle help maps` lists them (unreal)
IN ?= .
OUT ?= maps
SETS ?= unreal
WRINKLE ?= wrinkle
names := $(patsubst $(IN)/%.wrinkle,%,$(wildcard $(IN)/*.wrinkle))

all: $(foreach set,$(SETS) bodies,$(names:%=$(OUT)/$(set)/%.json))
.PHONY: all
.DELETE_ON_ERROR:

# The receipts of the files are the target: they are there if all files are.
define set_rule
$(OUT)/$(1)/%.json: $(IN)/%.wrinkle
	@mkdir -p $$(@D)
	$(WRINKLE) export $$< --as $(1) -o $$(@D) --threads 1 --json > $$@
endef
$(foreach set,$(SETS),$(eval $(call set_rule,$(set))))

$(OUT)/bodies/%.json: $(IN)/%.wrinkle
	@mkdir -p $(@D)
	$(WRINKLE) export $< --as stl error=0.2 -o $(@D)/ --threads 1 --json > $@
