//! What is lit (Sec. 2): meshes, materials, lights, camera, receiver.
