import sys,json,time,os
os.environ.setdefault('OMP_NUM_THREADS','1')
import numpy as np
from lean import Dhat
# Chebyshev nodes in ln kL (NK) and nu (NN); F = kL exp(kL) Dhat
NK,NN,lo,hi=20,6,.1,15.
s=np.log(lo)+np.log(hi/lo)*(1+np.cos((np.arange(NK)+.5)*np.pi/NK))/2; n=.25+.25*np.cos((np.arange(NN)+.5)*np.pi/NN)
T=np.zeros((NN,NK,10,10)); t=time.time()
for i,nu in enumerate(n):
    for j,q in enumerate(np.exp(s)): T[i,j]=q*np.exp(q)*Dhat(q,nu,deg=9,h=.3,lo=1e-8)
    print(i,time.time()-t,flush=True)
np.savez('table.npz',T=T,kL=np.exp(s),nu=n)
