# The bundle's run-all with a false program in place of tetrace, then the bundle itself (target `bundle`).
foreach(claim steps_that_end_well_give_0 the_time_of_all_steps_shortens_later_ones_and_then_skips_them a_hang_and_a_failure_lose_no_other_step known_defects_of_compilers_are_no_failure
    results_are_added_under_their_commit_with_a_page
    what_is_packed_is_unpacked_for_the_steps each_gpu_has_its_share_of_the_tables
    a_hanging_look_for_devices_costs_no_picture_of_other_apis the_summary_is_json_too
    an_interrupt_ends_the_step_and_keeps_the_summary refuses_what_it_does_not_know)
  add_test(NAME RunAll.${claim}
    COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/run_all_test.sh ${claim} ${PROJECT_SOURCE_DIR}/bundle)
  set_tests_properties(RunAll.${claim} PROPERTIES LABELS large SKIP_RETURN_CODE 77 TIMEOUT 120)
endforeach()

if(TARGET bundle)
  # First with the smallest scene: building and packing all of them takes two minutes.
  add_test(NAME Bundle.builds COMMAND ${CMAKE_COMMAND} -E env TETRACE_BUNDLE_SCENES=banana
    ${CMAKE_COMMAND} --build ${CMAKE_BINARY_DIR} --target bundle)
  add_test(NAME Bundle.builds_with_all_scenes COMMAND ${CMAKE_COMMAND} --build ${CMAKE_BINARY_DIR} --target bundle)
  set_tests_properties(Bundle.builds PROPERTIES FIXTURES_SETUP bundle LABELS large PROCESSORS 2 TIMEOUT 600)
  set_tests_properties(Bundle.builds_with_all_scenes PROPERTIES FIXTURES_SETUP all_scenes DEPENDS Bundle.builds
    LABELS "large;campaign" PROCESSORS 2 TIMEOUT 600)
  set(stub "")
  if(TARGET tetrace_stub_cuda)
    set(stub $<TARGET_FILE_DIR:tetrace_stub_cuda>)
  endif()
  foreach(claim brings_every_library_but_the_systems states_licences_and_the_c_library traces_without_this_systems_drivers
      runs_all_steps_without_this_systems_drivers)
    add_test(NAME Bundle.${claim}
      COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/bundle_test.sh ${claim} ${CMAKE_BINARY_DIR}/bundle "${stub}")
    set_tests_properties(Bundle.${claim} PROPERTIES FIXTURES_REQUIRED bundle LABELS large TIMEOUT 600)
  endforeach()
  set_tests_properties(Bundle.runs_all_steps_without_this_systems_drivers PROPERTIES
    FIXTURES_REQUIRED "bundle;all_scenes" PROCESSORS 2 LABELS "large;campaign")
endif()
