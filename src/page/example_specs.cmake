# The specs that the page offers to start from, the published design first.
set(example_specs)
foreach(name holybro-x500 headroom-range hexacopter-400v reference/hanging-offset
        reference/high-voltage-hexacopter reference/infeasible-power-hover)
  list(APPEND example_specs "${PROJECT_SOURCE_DIR}/examples/${name}.json")
endforeach()
