function(gloam_compile_shaders target)
endfunction()
