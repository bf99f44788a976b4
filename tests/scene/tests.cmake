wr_test(scene scene)
wr_test(normal_map scene)
wr_test(combine scene)
