wr_test(scene scene)
wr_test(normal_map scene)
