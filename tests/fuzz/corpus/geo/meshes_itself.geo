DefineConstant[ width = {1, Name "width"} ];
/* a */ Mesh.Algorithm = 8; // b
MeshAlgorithm Surface {1} = 8;
Mesh 2;
